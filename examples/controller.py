#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A stranger's controller: PD on the motors, against the messages alone. The law is in torque().

Debian has no LCM for Python: short messages are a header (magic, number), the channel's name, and the bytes of
lcm-gen's own types (lcm-gen --python), over UDP multicast.
"""
import os
import re
import select
import socket
import struct
import sys
import time

from mixloop_lcm import command_t, reference_t, sim_control_t, state_t

KP, KV = (100.0, 25.0, 25.0), (1.0, 0.5, 0.5)


def torque(i, psi, psid, psi_d, psid_d):
    return KP[i] * (psi_d - psi) + KV[i] * (psid_d - psid)


class Bus:
    MAGIC = 0x4C433032  # "LC02"

    def __init__(self, url):
        group, port = re.match(r"udpm://([\d.]+):(\d+)", url).groups()
        self.address, self.number = (group, int(port)), 0
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        self.socket.bind(("", int(port)))
        self.socket.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 0)
        self.socket.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, socket.inet_aton(group) + bytes(4))
        self.socket.settimeout(10)

    def receive(self):
        """All that waits, oldest first; something must come within 10 s."""
        datagrams = [self.socket.recv(65536)]
        while select.select([self.socket], [], [], 0)[0]:
            datagrams.append(self.socket.recv(65536))
        for datagram in datagrams:
            magic, _ = struct.unpack_from(">II", datagram)
            channel, _, data = datagram[8:].partition(b"\0")
            if magic == self.MAGIC:
                yield channel.decode(), data

    def publish(self, channel, message):
        header = struct.pack(">II", self.MAGIC, self.number) + channel.encode() + b"\0"
        self.number += 1
        self.socket.sendto(header + message.encode(), self.address)


def answer(state, desired):
    """STATE(k) by COMMAND(k)."""
    command = command_t()
    command.n, command.utime, command.seq = state.n, state.utime, state.seq
    command.session, command.config = state.session, state.config
    command.tau_commanded = [
        torque(i, state.psi_measured[i], state.psid_measured[i], desired.psi_desired[i], desired.psid_desired[i])
        for i in range(state.n)
    ]
    return command


class Run:
    """What was heard of one run, the first; of another one when that has been silent for a second."""

    def __init__(self):
        self.state, self.references, self.asked, self.done, self.heard = None, {}, False, False, 0

    def take(self, channel, data):
        if channel == "MIXLOOP_STATE":
            self.take_state(state_t.decode(data))
        elif channel == "MIXLOOP_REFERENCE":
            reference = reference_t.decode(data)
            if reference.n == 3 and (not self.state or reference.session == self.state.session):
                self.references[reference.seq] = reference
                self.references.pop(reference.seq - 10, None)
        elif channel == "MIXLOOP_SIM_CONTROL":
            control = sim_control_t.decode(data)
            ours = self.state and control.session == self.state.session
            self.done = self.done or (ours and control.action == sim_control_t.ACTION_END)

    def take_state(self, state):
        if state.n != 3:  # the law above is for three motors
            return
        now = time.monotonic()
        if self.state and state.session == self.state.session:
            if state.seq < self.state.seq:  # overtaken
                return
        elif self.state and now - self.heard < 1:  # another run on the same bus
            return
        self.state, self.asked, self.heard = state, True, now


def main():
    bus, run, command = Bus(os.environ.get("LCM_DEFAULT_URL", "udpm://239.255.76.67:7667")), Run(), None
    while not run.done:
        try:
            for channel, data in bus.receive():
                run.take(channel, data)
        except TimeoutError:
            sys.exit("no plant for 10 s")
        # What the newest state has made late needs no answer.
        desired = run.references.get(run.state.seq) if run.asked else None
        if not desired or desired.session != run.state.session:
            continue
        if not command or (command.session, command.seq) != (run.state.session, run.state.seq):
            command = answer(run.state, desired)
        bus.publish("MIXLOOP_COMMAND", command)  # a repeated state gets the same bytes
        run.asked = False


if __name__ == "__main__":
    main()
