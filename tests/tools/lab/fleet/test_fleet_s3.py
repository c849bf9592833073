"""ale-fleet over logs in storage that speaks S3, on a server of this computer."""
import os
import socket
import subprocess
import sys

import pytest

from at_hand import free_tcp_port
from fleet_at_work import LOGS, said_by
from waiting import wait_until

pytest.importorskip("distributed", reason="python3-distributed is not here")
for needed in ("s3fs", "boto3", "moto", "flask_cors"):
    pytest.importorskip(needed, reason=f"PyPI's {needed} is not here")
import boto3  # noqa: E402


def answers(port):
    with socket.socket() as probe:
        return probe.connect_ex(("127.0.0.1", port)) == 0


@pytest.fixture(scope="module")
def bucket(drives, tmp_path_factory):
    """A client of it, and the environment in which it is found; it holds the logs and their truths."""
    port = free_tcp_port()
    here = {"AWS_ENDPOINT_URL": f"http://127.0.0.1:{port}", "AWS_ACCESS_KEY_ID": "a", "AWS_SECRET_ACCESS_KEY": "b", "AWS_DEFAULT_REGION": "us-east-1"}
    log = (tmp_path_factory.mktemp("moto") / "said").open("wb")
    server = subprocess.Popen([sys.executable, "-m", "moto.server", "-H", "127.0.0.1", "-p", str(port)], stdout=log, stderr=log)
    try:
        wait_until(lambda: server.poll() is not None or answers(port), 60, "the server of S3 answers")
        client = boto3.client("s3", endpoint_url=here["AWS_ENDPOINT_URL"], aws_access_key_id="a", aws_secret_access_key="b", region_name="us-east-1")
        client.create_bucket(Bucket="drives")
        for k in range(LOGS):
            client.upload_file(drives / f"d{k}.log", "drives", f"d{k}.log")
            client.upload_file(drives / f"truths/d{k}.tum", "drives", f"truths/d{k}.tum")
        yield client, {**os.environ, **here}
    finally:
        server.terminate()
        server.wait()


def test_logs_and_truths_from_there_give_the_table_of_those_from_here(bucket, drives, tmp_path):
    tables = []
    for name, folder in (("there", "s3://drives"), ("here", drives)):
        said_by("replay", *(f"{folder}/d{k}.log" for k in range(LOGS)), "--against", f"{folder}/truths", "--out", tmp_path / f"{name}.csv", "--workers", "2",
                env=bucket[1])
        tables.append((tmp_path / f"{name}.csv").read_text(encoding="utf-8").replace(f"{folder}/", ""))
    assert tables[0] == tables[1]
    assert "d3.log,60,0,0," in tables[0]


def test_what_is_not_there_is_a_row_that_says_so(bucket, tmp_path):
    said = said_by("replay", "s3://drives/absent.log", "s3://drives/d0.log", "--out", tmp_path / "table.csv", "--workers", "1", env=bucket[1], code=1)
    assert "s3://drives/absent.log: The specified key does not exist." in said
    assert len((tmp_path / "table.csv").read_text(encoding="utf-8").splitlines()) == 3


def test_drives_on_their_way_into_a_map_may_be_kept_there(bucket, tmp_path):
    client, environment = bucket
    said = said_by("merge", "s3://drives/d0.log", "s3://drives/d1.log", "--out", tmp_path / "one.map", "--parts", "s3://drives/parts", "--workers", "2",
                   env=environment, code=1)
    assert "1 of 2 drives are one map" in said
    assert not client.list_objects_v2(Bucket="drives", Prefix="parts").get("Contents")
