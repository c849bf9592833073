"""ale.bags on bags of both generations of ROS: echoes, odometry and mounting as /tf tells them."""
import pytest

pytest.importorskip("rosbags", reason="PyPI's rosbags is not here")
pytest.importorskip("foxglove", reason="PyPI's foxglove-sdk is not here")

from test_bags import MOUNTED, drive, write_old_ros1, write_ros1, write_ros2, write_single_mcap  # noqa: E402,F401 (drive is a fixture)


@pytest.fixture
def bags(ale):
    return pytest.importorskip(f"{ale.__name__}.bags")


def way(tracker):
    return tracker.trajectory().tobytes()


@pytest.mark.parametrize("write, name", [(write_ros1, "drive.bag"), (write_old_ros1, "drive.bag"), (write_ros2, "drive")])
def test_odometry_by_tf_alone_is_odometry_and_the_scanner_sits_where_tf_says(bags, write, name, drive, tmp_path):  # noqa: F811
    told = write(tmp_path / name, drive, mounted=MOUNTED)
    (tmp_path / "tf").mkdir()
    by_tf = write(tmp_path / "tf" / name, drive, mounted=MOUNTED, by_tf=True, late=True)
    for bag in (told, by_tf):
        assert bags.mounting(bag) == pytest.approx(MOUNTED)
    assert [event[:4] for event in bags.read(told) if isinstance(event, bags.Odometry)] == [
        event[:4] for event in bags.read(by_tf) if isinstance(event, bags.Odometry)]
    assert way(bags.track(told)) == way(bags.track(by_tf)) == way(bags.track(told, sensor=bags.mounting(told)))
    assert way(bags.track(told, sensor=(0.0, 0.0, 0.0))) != way(bags.track(told))


def test_of_several_echoes_the_first_counts(bags, drive, tmp_path):  # noqa: F811
    plain, echoes = write_ros2(tmp_path / "plain", drive[:60]), write_ros2(tmp_path / "echoes", drive[:60], echoes=True)
    assert way(bags.track(echoes)) == way(bags.track(plain)) == way(bags.track(write_single_mcap(tmp_path / "mcap", drive[:60])))


def test_a_topic_that_is_not_there_is_told_with_those_that_are(bags, drive, tmp_path):  # noqa: F811
    bag = write_ros2(tmp_path / "bag", drive[:6])
    for ask in (lambda: bags.track(bag, scan_topic="/lidar"), lambda: list(bags.read(bag, scan_topic="/lidar"))):
        with pytest.raises(ValueError, match=r"no topic /lidar of sensor_msgs/msg/LaserScan \(there: /scan\)"):
            ask()
    with pytest.raises(ValueError, match=r"no topic /wheels"):
        list(bags.read(bag, odometry_topic="/wheels"))
