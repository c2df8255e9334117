#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A stranger's controller: PD on the motors, against the messages alone. The law is in torque().

Debian has no LCM for Python: short messages are a header (magic, number), the channel's name, and the bytes of
lcm-gen's own types (lcm-gen --python), over UDP multicast.
"""
import os
import re
import socket
import struct

from mixloop import command_t, reference_t, sim_control_t, state_t

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
        datagram = self.socket.recv(65536)
        magic, _ = struct.unpack_from(">II", datagram)
        channel, _, data = datagram[8:].partition(b"\0")
        return (channel.decode(), data) if magic == self.MAGIC else ("", b"")

    def publish(self, channel, message):
        header = struct.pack(">II", self.MAGIC, self.number) + channel.encode() + b"\0"
        self.number += 1
        self.socket.sendto(header + message.encode(), self.address)


def answer(bus, state, desired):
    """STATE(k) by COMMAND(k); a repeated state gets the same answer."""
    command = command_t()
    command.n, command.utime, command.seq = state.n, state.utime, state.seq
    command.session, command.config = state.session, state.config
    command.tau_commanded = [
        torque(i, state.psi_measured[i], state.psid_measured[i], desired.psi_desired[i], desired.psid_desired[i])
        for i in range(state.n)
    ]
    bus.publish("MIXLOOP_COMMAND", command)


def main():
    bus = Bus(os.environ.get("LCM_DEFAULT_URL", "udpm://239.255.76.67:7667"))
    state, references = None, {}
    while True:
        channel, data = bus.receive()
        if channel == "MIXLOOP_STATE":
            state = state_t.decode(data)
        elif channel == "MIXLOOP_REFERENCE":
            reference = reference_t.decode(data)
            references[reference.seq] = reference
            references.pop(reference.seq - 10, None)
            if not state or reference.seq != state.seq:
                continue
        elif channel == "MIXLOOP_SIM_CONTROL" and sim_control_t.decode(data).action == sim_control_t.ACTION_END:
            return
        else:
            continue
        desired = references.get(state.seq) if state else None
        if desired and state.n == 3 and desired.session == state.session:
            answer(bus, state, desired)


if __name__ == "__main__":
    main()
