# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The Glint Authors
"""Stops one thread of a process from outside, as a debugger does, for two minutes or until the process ends.

usage: freeze_thread.py PID NAME
NAME is what the thread is called; without such a thread the last one is taken.
"""
import ctypes
import os
import sys
import time

PTRACE_ATTACH = 16
WALL = 0x40000000  # Threads, too.
pid, name = int(sys.argv[1]), sys.argv[2]
threads = sorted(int(t) for t in os.listdir(f"/proc/{pid}/task"))


def called(thread):
    with open(f"/proc/{pid}/task/{thread}/comm", encoding="utf-8") as file:
        return file.read().strip()


named = [t for t in threads if name in called(t)]
thread = (named or threads[1:] or threads)[-1]
libc = ctypes.CDLL(None, use_errno=True)
libc.ptrace.argtypes = [ctypes.c_long, ctypes.c_long, ctypes.c_void_p, ctypes.c_void_p]
if libc.ptrace(PTRACE_ATTACH, thread, None, None) != 0:
    sys.exit(f"cannot stop thread {thread}: {os.strerror(ctypes.get_errno())}")
# A thread that was killed is not gone before who holds it has looked.
end = time.monotonic() + 120
while time.monotonic() < end:
    ended, status = os.waitpid(thread, os.WNOHANG | WALL)
    if ended and (os.WIFSIGNALED(status) or os.WIFEXITED(status)):
        break
    time.sleep(0.2)
