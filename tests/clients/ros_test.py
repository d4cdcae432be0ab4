# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The Glint Authors
"""The ROS node on ROS 1: what its topics carry is what the daemon says.

usage: ros_test.py GLINTD
"""
import os
import subprocess
import sys
import tempfile
import time
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "support"))
from glintd_process import ROOT, GlintdProcess, await_status, free_port
from glint_client import Client

GLINTD = sys.argv.pop(1)
try:
    import numpy
    import rosmaster  # noqa: F401, run as a program
    import rospy
    from nav_msgs.msg import Odometry
    from sensor_msgs.msg import PointCloud2
    from tf2_msgs.msg import TFMessage
    sys.path.insert(0, os.path.join(ROOT, "clients", "ros"))
    from glint_ros import fixed_axes_covariance, rotation_matrix
except ImportError as missing:
    print(f"ros_test.py: skipped, {missing}: .ci/install-packages all has it", file=sys.stderr)
    sys.exit(77)


class RosNode(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.home = tempfile.TemporaryDirectory(prefix="glint-ros-")
        port = free_port()
        os.environ.update(ROS_MASTER_URI=f"http://127.0.0.1:{port}", ROS_HOSTNAME="127.0.0.1", ROS_HOME=cls.home.name,
                          PYTHONPATH=os.path.join(ROOT, "clients", "python"))
        cls.master = subprocess.Popen(["rosmaster", "--core", "-p", str(port)], stdout=subprocess.DEVNULL)
        cls.daemon = GlintdProcess(GLINTD, **{"mount.T_base_sensor": "[0.1, 0.2, 0.3, 0, 0, 0, 1]"})
        cls.daemon.start()
        cls.client = Client(cls.daemon.tcp)
        cls.node = subprocess.Popen(
            ["/usr/bin/python3", os.path.join(ROOT, "clients", "ros", "glint_ros.py"), f"_target:={cls.daemon.tcp}",
             "_stamps:=sensor", "_map_period_s:=0.5", "_child_frame:=robot"])
        deadline = time.monotonic() + 20
        while True:
            try:
                rospy.init_node("listener", disable_signals=True)
                break
            except Exception:
                assert time.monotonic() < deadline, "rosmaster does not come up"
                time.sleep(0.1)
        await_status(cls.client, lambda status: status["map"]["keyframes"] >= 3)

    @classmethod
    def tearDownClass(cls):
        cls.client.close()
        for process in (cls.node, cls.master):
            process.terminate()
            process.wait(20)
        cls.daemon.__exit__()
        cls.home.cleanup()

    def test_1_odometry_is_the_daemons(self):
        odometry = rospy.wait_for_message("/glint/odom", Odometry, 20)
        self.assertEqual(("odom", "robot"), (odometry.header.frame_id, odometry.child_frame_id))
        pose = self.client.get_pose("odom", "base", at_ns=odometry.header.stamp.to_nsec())
        p, q = odometry.pose.pose.position, odometry.pose.pose.orientation
        numpy.testing.assert_allclose([p.x, p.y, p.z], pose["p_m"], atol=1e-9)
        numpy.testing.assert_allclose([q.x, q.y, q.z, q.w], pose["q_xyzw"], atol=1e-9)
        v = odometry.twist.twist.linear
        numpy.testing.assert_allclose([v.x, v.y, v.z], pose["v_mps"], atol=1e-9)
        covariance = numpy.reshape(odometry.pose.covariance, (6, 6))
        self.assertTrue((numpy.linalg.eigvalsh(covariance) > 0).all())

    def test_2_tf_leads_from_the_map_to_the_robot(self):
        transforms = rospy.wait_for_message("/tf", TFMessage, 20).transforms
        self.assertEqual([("map", "odom"), ("odom", "robot")],
                         [(t.header.frame_id, t.child_frame_id) for t in transforms])
        total = numpy.eye(4)
        for each in transforms:
            step = numpy.eye(4)
            q, t = each.transform.rotation, each.transform.translation
            step[:3, :3], step[:3, 3] = rotation_matrix([q.x, q.y, q.z, q.w]), [t.x, t.y, t.z]
            total = total @ step
        pose = self.client.get_pose("map", "base", at_ns=transforms[0].header.stamp.to_nsec())
        numpy.testing.assert_allclose(total[:3, 3], pose["p_m"], atol=1e-6)
        numpy.testing.assert_allclose(total[:3, :3], rotation_matrix(pose["q_xyzw"]), atol=1e-6)

    def test_3_the_map_is_the_daemons(self):
        self.client.pause()
        await_status(self.client, lambda status: status["state"] == "PAUSED" and not status["queues"]["keyframes"]["size"])
        try:
            expected = self.client.get_map(voxel_m=0.2)
            deadline = time.monotonic() + 20
            cloud = None
            while cloud is None or cloud.width != expected.count:
                self.assertLess(time.monotonic(), deadline, (cloud and cloud.width, expected.count))
                cloud = rospy.wait_for_message("/glint/map", PointCloud2, 20)  # Latched: at once.
                time.sleep(0.3)
            self.assertEqual(("map", ["x", "y", "z", "intensity"]),
                             (cloud.header.frame_id, [field.name for field in cloud.fields]))
            points = numpy.frombuffer(cloud.data, "<f4").reshape(-1, 4)
            ordered = lambda cloud: cloud[numpy.lexsort(cloud.T)]
            numpy.testing.assert_array_equal(ordered(expected.points()), ordered(points))
        finally:
            self.client.resume()

    def test_4_it_outlives_a_restart_of_the_daemon(self):
        before = rospy.wait_for_message("/glint/odom", Odometry, 20).header.stamp
        self.daemon.stop()
        time.sleep(1)
        self.daemon.start()
        after = rospy.wait_for_message("/glint/odom", Odometry, 30)
        self.assertNotEqual(before, after.header.stamp)
        self.assertIsNone(self.node.poll())


class Covariance(unittest.TestCase):
    def test_it_turns_with_the_pose(self):
        quarter = [0, 0, 0.5 ** 0.5, 0.5 ** 0.5]  # The child's x is the frame's y.
        turned = numpy.reshape(fixed_axes_covariance(numpy.diag([1, 2, 3, 4, 5, 6]).ravel(), quarter), (6, 6))
        numpy.testing.assert_allclose(turned, numpy.diag([2, 1, 3, 5, 4, 6]), atol=1e-12)


if __name__ == "__main__":
    unittest.main()
