"""Measures what datagrams and messages over TCP meet on a link that Linux's netem emulates.

Run as root on a kernel with netem: python3 bench/netem/run.py. It makes a namespace "skein-b" and removes it.
`link/Test/runMain skein.link.lossFigures` prints the same of Skein's own link, in virtual time.
Times are in ms; "0.95:250" is a quantile.
"""
import ctypes
import heapq
import os
import select
import socket
import struct
import subprocess
import time

HOME = os.open("/proc/self/ns/net", os.O_RDONLY)
LIBC = ctypes.CDLL(None, use_errno=True)
SPACE = "skein-b"
INSIDE = f"ip netns exec {SPACE} "


def shell(command, may_fail=False):
    done = subprocess.run(command, shell=True, capture_output=True, text=True)
    if done.returncode and not may_fail:
        raise SystemExit(f"{command}: {done.stderr.strip()}")


def inside(make):
    """Makes a socket in the namespace."""
    there = os.open(f"/run/netns/{SPACE}", os.O_RDONLY)
    assert LIBC.setns(there, 0) == 0
    made = make()
    assert LIBC.setns(HOME, 0) == 0
    os.close(there)
    return made


def emulate(there, back):
    shell("tc qdisc del dev va root", may_fail=True)
    shell(INSIDE + "tc qdisc del dev vb root", may_fail=True)
    for each in "ip tcp_metrics flush", INSIDE + "ip tcp_metrics flush":
        shell(each, may_fail=True)
    if there:
        shell(f"tc qdisc add dev va root netem limit 100000 {there}")
    if back:
        shell(f"{INSIDE}tc qdisc add dev vb root netem limit 100000 {back}")


def quantiles(samples):
    ordered = sorted(samples)
    at = lambda p: ordered[min(len(ordered) - 1, int(p * len(ordered)))]
    parts = [f"{p}:{at(p):.0f}" for p in (.5, .8, .9, .95, .97, .98, .99, .995, .999)]
    return f"{' '.join(parts)} mean:{sum(ordered) / len(ordered):.1f} max:{ordered[-1]:.0f} n:{len(ordered)}"


def datagrams(label, there, count=20_000, every_s=.002):
    emulate(there, "")
    to = inside(lambda: socket.socket(socket.AF_INET, socket.SOCK_DGRAM))
    to.bind(("10.0.0.2", 7000))
    to.setblocking(False)
    to.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 22)
    out = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    out.connect(("10.0.0.2", 7000))
    came = {}

    def drain():
        while True:
            try:
                number, sent = struct.unpack("id", to.recv(100))
            except BlockingIOError:
                return
            came[number] = (time.monotonic() - sent) * 1e3

    begin = time.monotonic()
    for number in range(count):
        out.send(struct.pack("id", number, time.monotonic()))
        while (left := begin + (number + 1) * every_s - time.monotonic()) > 0:
            select.select([to], [], [], left)
            drain()
    time.sleep(.5)
    drain()
    lost = [number not in came for number in range(count)]
    runs = sum(lost[i] and (i == 0 or not lost[i - 1]) for i in range(count))
    print("UDP", label, f"loss {sum(lost) / count:.4f} runs {runs} burst {sum(lost) / max(1, runs):.3f}",
          quantiles(came.values()), flush=True)


def messages(label, there, back, connections, each, every_s, answers=False, size=64):
    emulate(there, back)
    listener = inside(socket.socket)
    listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    listener.bind(("10.0.0.2", 7001))
    listener.listen(200)
    poll, sides, clients, held = select.poll(), {}, [], {}
    for _ in range(connections):
        client = socket.socket()
        client.connect(("10.0.0.2", 7001))
        server, _ = listener.accept()
        clients.append(client)
        for end in client, server:
            end.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            end.setblocking(False)
            poll.register(end, select.POLLIN)
            sides[end.fileno()] = end
            held[end.fileno()] = b""
    at_client = {client.fileno() for client in clients}
    one_way, both, stop = [], [], None
    begin = time.monotonic() + 1
    due = [(begin + every_s * i / connections, i, 0) for i in range(connections)]
    heapq.heapify(due)
    while True:
        now = time.monotonic()
        while due and due[0][0] <= now:
            at, i, number = heapq.heappop(due)
            clients[i].send(struct.pack("d", time.monotonic()).ljust(size, b"."))
            if number + 1 < each:
                heapq.heappush(due, (at + every_s, i, number + 1))
        if not due and stop is None:
            stop = now + 30
        if stop and (now > stop or len(both if answers else one_way) >= connections * each):
            break
        for descriptor, _ in poll.poll(max(0, (due[0][0] - now) * 1e3) if due else 1000):
            end = sides[descriptor]
            held[descriptor] += end.recv(65536)
            now = time.monotonic()
            while len(held[descriptor]) >= size:
                message, held[descriptor] = held[descriptor][:size], held[descriptor][size:]
                took = (now - struct.unpack("d", message[:8])[0]) * 1e3
                (both if descriptor in at_client else one_way).append(took)
                if answers and descriptor not in at_client:
                    end.send(message)
    print("TCP", label, "one-way", quantiles(one_way), flush=True)
    if answers:
        print("TCP", label, "round trip", quantiles(both), flush=True)
    for end in [listener, *sides.values()]:
        end.close()


def main():
    shell(f"ip netns add {SPACE}")
    try:
        shell(f"ip link add va type veth peer name vb netns {SPACE}")
        shell("ip addr add 10.0.0.1/24 dev va && ip link set va up")
        shell(f"{INSIDE}ip addr add 10.0.0.2/24 dev vb && {INSIDE}ip link set vb up")
        random, bursts = "loss random 5%", "loss gemodel 1.315789% 25%"
        datagrams("loss:5%", f"delay 50ms {random}")
        datagrams("loss:5%/4", f"delay 50ms {bursts}")
        for delay in "50ms", "18ms":
            there, back = f"delay {delay} {random}", f"delay {delay}"
            messages(f"{delay} alone", there, back, 50, 100, 3, answers=True)
            messages(f"{delay} alone, both ways", there, there, 50, 100, 3, answers=True)
            messages(f"{delay} 10 Hz", there, back, 20, 500, .1)
            messages(f"{delay} 10 Hz, bursts", f"delay {delay} {bursts}", back, 20, 500, .1)
            messages(f"{delay} 50 Hz", there, back, 20, 1000, .02)
    finally:
        shell(f"ip netns del {SPACE}", may_fail=True)


if __name__ == "__main__":
    main()
