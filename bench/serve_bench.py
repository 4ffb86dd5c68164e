#!/usr/bin/env python3
"""Times requests to `splatcut serve`, and asks for a day's worth of them.

    bench/serve_bench.py SCENE X Y [SPLATCUT [REQUESTS]]

Prints CSV: what the first conversation costs (nothing prepared), the same one again, and REQUESTS (10,000) requests with
the memory of the process after every tenth of them."""
import json
import os
import subprocess
import sys
import tempfile
import time

scene, x, y = sys.argv[1], float(sys.argv[2]), float(sys.argv[3])
program = sys.argv[4] if len(sys.argv) > 4 else "build/release/splatcut"
count = int(sys.argv[5]) if len(sys.argv) > 5 else 10_000
cache = tempfile.TemporaryDirectory()
process = subprocess.Popen([program, "serve"], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                           env={**os.environ, "XDG_CACHE_HOME": cache.name})


def ask(do, **fields):
    start = time.monotonic()
    process.stdin.write(json.dumps({"id": do, "do": do, **fields}).encode() + b"\n")
    process.stdin.flush()
    while True:
        reply = json.loads(process.stdout.readline())
        if "progress" not in reply:
            return reply, time.monotonic() - start


def resident_mb():
    with open(f"/proc/{process.pid}/status", encoding="ascii") as status:
        return next(int(line.split()[1]) for line in status if line.startswith("VmRSS")) / 1024


conversation = [("open", {"scene": scene}), ("click", {"x": x, "y": y}), ("click", {"x": x + 12, "y": y}),
                ("size", {"step": 1}), ("preview", {"width": 640}), ("labels", {}), ("camera", {})]
print("request,first_s,again_s,next_spot_s")
first = [(do, ask(do, **fields)) for do, fields in conversation]
ask("clear")
again = [ask(do, **fields) for do, fields in conversation[1:]]
ask("clear")
spot = [ask(do, **({**fields, "x": fields["x"] + 40} if do == "click" else fields)) for do, fields in conversation[1:]]
for i, (do, (reply, seconds)) in enumerate(first):
    if not reply["ok"]:
        print(f"# {do}: {reply['error']}")
    print(f"{do},{seconds:.3f}" + (f",{again[i - 1][1]:.3f},{spot[i - 1][1]:.3f}" if i else ",,"))

ways = [("click", {"x": x, "y": y}), ("click", {"x": x + 12, "y": y, "label": "object"}),
        ("scribble", {"points": [[x, y], [x + 9, y + 9]]}), ("size", {"step": 1}), ("size", {"step": -1}),
        ("choice", {"choice": 2}), ("undo", {}), ("preview", {"width": 320}), ("labels", {}),
        ("click", {"x": -1, "y": 0}), ("settings", {"smoothness": 3}), ("settings", {}), ("clear", {})]
times = []
print("requests,resident_mb,requests_per_s,median_ms,p99_ms,longest_ms")
for i in range(count):
    do, fields = ways[i % len(ways)]
    if do in ("click", "scribble"):  # everywhere around, so that not all is known
        shift = 1 + i // len(ways) % 23
        fields = {k: v + shift if k in ("x", "y") and v > 0 else v for k, v in fields.items()}
    times.append(ask(do, **fields)[1])
    if (i + 1) % (count // 10) == 0:
        times.sort()
        n = len(times)
        print(f"{i + 1},{resident_mb():.0f},{n / sum(times):.0f},{1000 * times[n // 2]:.1f},{1000 * times[n * 99 // 100]:.1f},{1000 * times[-1]:.0f}", flush=True)
        times = []
ask("quit")
sys.exit(process.wait())
