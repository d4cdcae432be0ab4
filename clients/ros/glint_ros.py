#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The Glint Authors
"""glintd as a node of ROS 1 (rospy) or ROS 2 (rclpy), whichever is there. Needs glint_client.py where Python finds it.

    glint_ros.py _target:=127.0.0.1:7788 _child:=base                   # ROS 1
    glint_ros.py --ros-args -p target:=127.0.0.1:7788 -p child:=base    # ROS 2; not tried by the project's tests

Publishes tf map -> odom -> child, `~odom` (nav_msgs/Odometry) with each pose, and `~map` (sensor_msgs/PointCloud2, latched)
when the map has changed. Nothing is published while the pose is not known or old; the connection is made anew when it was
lost. Parameters:

    target         HOST:PORT, or the path of a Unix socket (127.0.0.1:7788)
    token          for daemons that ask for one ("")
    child          sensor or base (base)
    map_frame, odom_frame, child_frame    names of the frames (map, odom; base_link or os_sensor by child)
    rate_hz        at most so many poses a second; 0: every scan's (0)
    stamps         host: this machine's time, as far as it is known; sensor: the sensor's (host)
    map_period_s   the map is looked at so often; 0: never (2)
    map_voxel_m    one point in cubes of this edge; 0: all (0.2)
"""
import array
import sys
import threading
import time

import numpy

from glint_client import Client, ConnectionLost, GlintError

try:
    import rospy
except ImportError:
    rospy = None
    import rclpy
    import rclpy.qos
    from builtin_interfaces.msg import Time

from geometry_msgs.msg import TransformStamped
from nav_msgs.msg import Odometry
from sensor_msgs.msg import PointCloud2, PointField
from tf2_msgs.msg import TFMessage

# A pose of these is one of now.
GOOD_STATES = ("TRACKING", "DEGRADED", "LOCALIZING")
RETRY_S = 1.0


class Ros1:
    """What differs between the two, for rospy."""

    def __init__(self):
        rospy.init_node("glint")
        self.warn, self.ok = rospy.logwarn, lambda: not rospy.is_shutdown()

    def param(self, name, default):
        return type(default)(rospy.get_param("~" + name, default))

    def publisher(self, kind, name, latched=False):
        return rospy.Publisher(name.replace("~/", "~"), kind, queue_size=10, latch=latched)

    def stamp(self, ns):
        return rospy.Time(ns // 10**9, ns % 10**9)

    def byte_array(self, data):
        return data

    def turn(self):
        pass


class Ros2:
    """What differs between the two, for rclpy."""

    def __init__(self):
        rclpy.init(args=sys.argv)
        self.node = rclpy.create_node("glint")
        self.warn, self.ok = self.node.get_logger().warning, rclpy.ok

    def param(self, name, default):
        return self.node.declare_parameter(name, default).value

    def publisher(self, kind, name, latched=False):
        profile = rclpy.qos.QoSProfile(depth=1 if latched else 10)
        if latched:
            profile.durability = rclpy.qos.DurabilityPolicy.TRANSIENT_LOCAL
        return self.node.create_publisher(kind, name, profile)

    def stamp(self, ns):
        return Time(sec=ns // 10**9, nanosec=ns % 10**9)

    def byte_array(self, data):
        return array.array("B", data)

    def turn(self):
        rclpy.spin_once(self.node, timeout_sec=0.0)


def rotation_matrix(q_xyzw):
    x, y, z, w = q_xyzw
    return numpy.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


def fixed_axes_covariance(cov, q_xyzw):
    """Glint's covariance is along the child's axes, that of ROS along those of the frame of the pose."""
    turn = numpy.kron(numpy.eye(2), rotation_matrix(q_xyzw))
    return (turn @ numpy.reshape(cov, (6, 6)) @ turn.T).ravel().tolist()


def put_vector(message, values):
    message.x, message.y, message.z = values


def put_quaternion(message, q_xyzw):
    message.x, message.y, message.z, message.w = q_xyzw


class Node:
    def __init__(self, ros):
        self.ros = ros
        child = ros.param("child", "base")
        self.target, self.token = ros.param("target", "127.0.0.1:7788"), ros.param("token", "") or None
        self.frames = {"map": ros.param("map_frame", "map"), "odom": ros.param("odom_frame", "odom"),
                       "child": ros.param("child_frame", "base_link" if child == "base" else "os_sensor")}
        self.topic = {"child": child, "frame": "odom", "rate_hz": ros.param("rate_hz", 0.0) or None}
        self.host_stamps = ros.param("stamps", "host") == "host"
        self.map_period_s, self.map_voxel_m = ros.param("map_period_s", 2.0), ros.param("map_voxel_m", 0.2)
        self.tf = ros.publisher(TFMessage, "/tf")
        self.odometry = ros.publisher(Odometry, "~/odom")
        self.map = ros.publisher(PointCloud2, "~/map", latched=True)

    def run(self):
        if self.map_period_s > 0:
            threading.Thread(target=self.follow_map, daemon=True).start()
        client = self.connect()
        if client is None:
            return
        with client, client.subscribe("pose", **self.topic) as poses:
            reconnects = 0
            while self.ros.ok():
                pose = poses.next(0.5)
                if pose is not None:
                    self.publish_pose(pose)
                if poses.reconnects != reconnects:
                    reconnects = poses.reconnects
                    self.ros.warn(f"glintd at {self.target} is there again")
                self.ros.turn()

    def connect(self):
        """None when the node is to end before the daemon is there."""
        told = ""
        while self.ros.ok():
            try:
                return Client(self.target, token=self.token)
            except ConnectionLost as error:
                if str(error) != told:
                    self.ros.warn(f"{error} It is tried again.")
                told = str(error)
                time.sleep(RETRY_S)
        return None

    def publish_pose(self, pose):
        if "p_m" not in pose or pose["state"] not in GOOD_STATES or pose["stale"]:
            return
        stamp = self.ros.stamp(pose.get("t_host_ns", pose["t_ns"]) if self.host_stamps else pose["t_ns"])
        transforms = [self.transform(stamp, "odom", "child", pose)]
        if "T_map_odom" in pose:
            transforms.insert(0, self.transform(stamp, "map", "odom", pose["T_map_odom"]))
        self.tf.publish(TFMessage(transforms=transforms))
        message = Odometry(child_frame_id=self.frames["child"])
        message.header.stamp, message.header.frame_id = stamp, self.frames["odom"]
        put_vector(message.pose.pose.position, pose["p_m"])
        put_quaternion(message.pose.pose.orientation, pose["q_xyzw"])
        put_vector(message.twist.twist.linear, pose["v_mps"])
        put_vector(message.twist.twist.angular, pose["w_radps"])
        if "cov" in pose:
            message.pose.covariance = fixed_axes_covariance(pose["cov"], pose["q_xyzw"])
        self.odometry.publish(message)

    def transform(self, stamp, frame, child, pose):
        message = TransformStamped(child_frame_id=self.frames[child])
        message.header.stamp, message.header.frame_id = stamp, self.frames[frame]
        put_vector(message.transform.translation, pose["p_m"])
        put_quaternion(message.transform.rotation, pose["q_xyzw"])
        return message

    def follow_map(self):
        """In a thread of its own, with a connection of its own: a large map takes its time."""
        client = self.connect()
        known = None
        while self.ros.ok():
            try:
                if known is None:
                    known = client.get_map(voxel_m=self.map_voxel_m or None)
                    changed = True
                else:
                    changed = any(known.update())
                if changed and known.count > 0:
                    self.publish_map(known, client.get_pose("odom"))
            except GlintError:
                pass  # The poses' thread says when the daemon is gone; here it is asked again.
            time.sleep(self.map_period_s)

    def publish_map(self, known, pose):
        ns = pose.get("t_host_ns", pose["t_ns"]) if self.host_stamps else pose["t_ns"]
        points = known.points()
        message = PointCloud2(height=1, width=known.count, is_bigendian=False, point_step=16, row_step=16 * known.count,
                              is_dense=True)
        message.header.stamp, message.header.frame_id = self.ros.stamp(ns), self.frames["map"]
        message.fields = [PointField(name=name, offset=4 * i, datatype=PointField.FLOAT32, count=1)
                          for i, name in enumerate(("x", "y", "z", "intensity"))]
        message.data = self.ros.byte_array(points.tobytes())
        self.map.publish(message)


def main():
    try:
        Node(Ros2() if rospy is None else Ros1()).run()
    except GlintError as error:
        sys.exit(f"glint_ros: {error}")
    except KeyboardInterrupt:
        pass


if __name__ == "__main__":
    main()
