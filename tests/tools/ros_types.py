"""The messages of ROS 2 for PyPI's cyclonedds, written from their public definitions; what a reader got, with its bytes."""
from dataclasses import dataclass

from cyclonedds.idl import IdlStruct
from cyclonedds.idl.annotations import final
from cyclonedds.idl.types import array, byte, float32, float64, int8, int32, sequence, uint8, uint32


def ros(package, name):
    """The class as ROS 2 calls its type on DDS; an object that was read keeps its bytes."""
    def made(cls):
        struct = final(dataclass(cls))
        plain = struct.deserialize

        def deserialize(data, has_header=True, use_version_2=None):
            message = plain(data, has_header, use_version_2)
            message.raw = bytes(data)
            return message
        struct.deserialize = staticmethod(deserialize)
        struct.ros_name = f"{package}/msg/{name}"
        return struct
    return made


def typename(package, name):
    return f"{package}::msg::dds_::{name}_"


@ros("builtin_interfaces", "Time")
class Time(IdlStruct, typename=typename("builtin_interfaces", "Time")):
    sec: int32 = 0
    nanosec: uint32 = 0


@ros("builtin_interfaces", "Duration")
class Duration(IdlStruct, typename=typename("builtin_interfaces", "Duration")):
    sec: int32 = 0
    nanosec: uint32 = 0


@ros("std_msgs", "Header")
class Header(IdlStruct, typename=typename("std_msgs", "Header")):
    stamp: Time
    frame_id: str


@ros("std_msgs", "ColorRGBA")
class ColorRGBA(IdlStruct, typename=typename("std_msgs", "ColorRGBA")):
    r: float32
    g: float32
    b: float32
    a: float32


@ros("geometry_msgs", "Point")
class Point(IdlStruct, typename=typename("geometry_msgs", "Point")):
    x: float64 = 0.0
    y: float64 = 0.0
    z: float64 = 0.0


@ros("geometry_msgs", "Vector3")
class Vector3(IdlStruct, typename=typename("geometry_msgs", "Vector3")):
    x: float64 = 0.0
    y: float64 = 0.0
    z: float64 = 0.0


@ros("geometry_msgs", "Quaternion")
class Quaternion(IdlStruct, typename=typename("geometry_msgs", "Quaternion")):
    x: float64 = 0.0
    y: float64 = 0.0
    z: float64 = 0.0
    w: float64 = 1.0


@ros("geometry_msgs", "Pose")
class Pose(IdlStruct, typename=typename("geometry_msgs", "Pose")):
    position: Point
    orientation: Quaternion


@ros("geometry_msgs", "PoseWithCovariance")
class PoseWithCovariance(IdlStruct, typename=typename("geometry_msgs", "PoseWithCovariance")):
    pose: Pose
    covariance: array[float64, 36]


@ros("geometry_msgs", "PoseWithCovarianceStamped")
class PoseWithCovarianceStamped(IdlStruct, typename=typename("geometry_msgs", "PoseWithCovarianceStamped")):
    header: Header
    pose: PoseWithCovariance


@ros("geometry_msgs", "PoseStamped")
class PoseStamped(IdlStruct, typename=typename("geometry_msgs", "PoseStamped")):
    header: Header
    pose: Pose


@ros("geometry_msgs", "Twist")
class Twist(IdlStruct, typename=typename("geometry_msgs", "Twist")):
    linear: Vector3
    angular: Vector3


@ros("geometry_msgs", "TwistStamped")
class TwistStamped(IdlStruct, typename=typename("geometry_msgs", "TwistStamped")):
    header: Header
    twist: Twist


@ros("geometry_msgs", "TwistWithCovariance")
class TwistWithCovariance(IdlStruct, typename=typename("geometry_msgs", "TwistWithCovariance")):
    twist: Twist
    covariance: array[float64, 36]


@ros("geometry_msgs", "Transform")
class Transform(IdlStruct, typename=typename("geometry_msgs", "Transform")):
    translation: Vector3
    rotation: Quaternion


@ros("geometry_msgs", "TransformStamped")
class TransformStamped(IdlStruct, typename=typename("geometry_msgs", "TransformStamped")):
    header: Header
    child_frame_id: str
    transform: Transform


@ros("tf2_msgs", "TFMessage")
class TFMessage(IdlStruct, typename=typename("tf2_msgs", "TFMessage")):
    transforms: sequence[TransformStamped]


@ros("sensor_msgs", "LaserScan")
class LaserScan(IdlStruct, typename=typename("sensor_msgs", "LaserScan")):
    header: Header
    angle_min: float32
    angle_max: float32
    angle_increment: float32
    time_increment: float32
    scan_time: float32
    range_min: float32
    range_max: float32
    ranges: sequence[float32]
    intensities: sequence[float32]


@ros("sensor_msgs", "CompressedImage")
class CompressedImage(IdlStruct, typename=typename("sensor_msgs", "CompressedImage")):
    header: Header
    format: str
    data: sequence[uint8]


@ros("nav_msgs", "Odometry")
class Odometry(IdlStruct, typename=typename("nav_msgs", "Odometry")):
    header: Header
    child_frame_id: str
    pose: PoseWithCovariance
    twist: TwistWithCovariance


@ros("nav_msgs", "MapMetaData")
class MapMetaData(IdlStruct, typename=typename("nav_msgs", "MapMetaData")):
    map_load_time: Time
    resolution: float32
    width: uint32
    height: uint32
    origin: Pose


@ros("nav_msgs", "OccupancyGrid")
class OccupancyGrid(IdlStruct, typename=typename("nav_msgs", "OccupancyGrid")):
    header: Header
    info: MapMetaData
    data: sequence[int8]


@ros("visualization_msgs", "UVCoordinate")
class UVCoordinate(IdlStruct, typename=typename("visualization_msgs", "UVCoordinate")):
    u: float32
    v: float32


@ros("visualization_msgs", "MeshFile")
class MeshFile(IdlStruct, typename=typename("visualization_msgs", "MeshFile")):
    filename: str
    data: sequence[uint8]


@ros("visualization_msgs", "Marker")
class Marker(IdlStruct, typename=typename("visualization_msgs", "Marker")):
    header: Header
    ns: str
    id: int32
    type: int32
    action: int32
    pose: Pose
    scale: Vector3
    color: ColorRGBA
    lifetime: Duration
    frame_locked: bool
    points: sequence[Point]
    colors: sequence[ColorRGBA]
    texture_resource: str
    texture: CompressedImage
    uv_coordinates: sequence[UVCoordinate]
    text: str
    mesh_resource: str
    mesh_file: MeshFile
    mesh_use_embedded_materials: bool


@ros("visualization_msgs", "MarkerArray")
class MarkerArray(IdlStruct, typename=typename("visualization_msgs", "MarkerArray")):
    markers: sequence[Marker]


@ros("diagnostic_msgs", "KeyValue")
class KeyValue(IdlStruct, typename=typename("diagnostic_msgs", "KeyValue")):
    key: str
    value: str


@ros("diagnostic_msgs", "DiagnosticStatus")
class DiagnosticStatus(IdlStruct, typename=typename("diagnostic_msgs", "DiagnosticStatus")):
    level: byte
    name: str
    message: str
    hardware_id: str
    values: sequence[KeyValue]


@ros("diagnostic_msgs", "DiagnosticArray")
class DiagnosticArray(IdlStruct, typename=typename("diagnostic_msgs", "DiagnosticArray")):
    header: Header
    status: sequence[DiagnosticStatus]
