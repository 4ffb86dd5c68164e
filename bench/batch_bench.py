#!/usr/bin/env python3
"""Times a list of jobs as single commands, as one batch, by two workers and as two shards, with the most memory of all
processes together; then kills a batch at random moments and compares what is there in the end.

    bench/batch_bench.py JOBS.jsonl [SPLATCUT [KILLS]]

Prints CSV: wall and CPU seconds (the second also where the machine does other work). Every row begins with an empty cache. Jobs in the same scene share its cache also as single commands."""
import json
import os
import random
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

jobs = Path(sys.argv[1]).resolve()
program = str(Path(sys.argv[2] if len(sys.argv) > 2 else "build/release/splatcut").resolve())
kills = int(sys.argv[3]) if len(sys.argv) > 3 else 20
place = Path(tempfile.mkdtemp())
environment = {**os.environ, "XDG_CACHE_HOME": str(place / "cache")}


def words_of(job):
    """The options of `cut` that a job says."""
    for key, value in job.items():
        if key in ("name", "scene"):
            continue
        if isinstance(value, bool):
            yield from [f"--{key}"] * value
            continue
        several = isinstance(value, list) and key in ("click", "box", "set", "write") and not isinstance(value[0], (int, float))
        for one in value if several else [value]:
            yield f"--{key}=" + (",".join(map(str, one)) if isinstance(one, list) else json.dumps(one) if isinstance(one, dict) else str(one))


def cpu_seconds():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def tree_kb():
    """Memory of this process's children and theirs; what several share counts once."""
    sum_kb, parents = 0, {}
    for entry in Path("/proc").iterdir():
        if entry.name.isdigit():
            try:
                parents[int(entry.name)] = int((entry / "stat").read_text().rsplit(")", 1)[1].split()[1])
            except OSError:
                pass
    for process in parents:
        above = process
        while above in parents and above != os.getpid():
            above = parents[above]
        if above == os.getpid() and process != above:
            try:
                text = Path(f"/proc/{process}/smaps_rollup").read_text()
                sum_kb += int(text.split("Pss:")[1].split()[0])
            except (OSError, IndexError):
                pass
    return sum_kb


def measure(name, commands_in_turn, at_once=1):
    shutil.rmtree(place / "cache", ignore_errors=True)
    most, ended = [0], threading.Event()

    def watch():
        while not ended.wait(0.05):
            most[0] = max(most[0], tree_kb())

    watcher = threading.Thread(target=watch)
    watcher.start()
    start, cpu = time.monotonic(), cpu_seconds()
    running = []
    for command in commands_in_turn:
        running.append(subprocess.Popen(command, env=environment, cwd=jobs.parent, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL))
        if len(running) == at_once:
            for process in running:
                process.wait()
            running = []
    print(f"{name},{time.monotonic() - start:.1f},{cpu_seconds() - cpu:.1f},{most[0] / 1024:.0f}", flush=True)
    ended.set()
    watcher.join()


def without_seconds(line):
    result = json.loads(line)
    result.pop("seconds")
    return json.dumps(result)


def contents(folder, also_reports=True):
    files = {}
    for path in sorted(folder.rglob("*")):
        if path.is_dir():
            continue
        if path.name == "result.json":
            files[path.relative_to(folder)] = without_seconds(path.read_text())
        elif path.name == "results.jsonl":
            files[path.relative_to(folder)] = [without_seconds(line) for line in path.read_text().splitlines()]
        elif path.name != "summary.csv" and "-of-" not in path.name and (also_reports or path.name != "report.json"):
            files[path.relative_to(folder)] = path.read_bytes()
    return files


def batch(folder, *more):
    return [program, "batch", str(jobs), "-o", str(place / folder), "--quiet", *more]


def main():
    listed = [json.loads(line) for line in jobs.read_text().splitlines() if line.strip() and not line.startswith("#")]
    print(f"way ({len(listed)} jobs),seconds,cpu_seconds,peak_mb")
    measure("one batch", [batch("one")])
    measure("one batch one thread", [batch("one_thread", "--threads", "1")])
    measure("two workers of one thread", [batch("two", "--jobs", "2", "--threads", "2")])
    measure("two shards of one thread", [batch("shards", "--shard", f"{i}/2", "--threads", "1") for i in (0, 1)], at_once=2)
    measure("single commands", [[program, "cut", job["scene"], *words_of(job), "-o", str(place / "single" / str(i)), "--quiet"]
                                for i, job in enumerate(listed)])
    subprocess.run(batch("shards"), env=environment, cwd=jobs.parent, check=False)
    whole = contents(place / "one")
    for folder in ("one_thread", "two", "shards"):
        print(f"{folder} as one batch: {contents(place / folder) == whole}")
    names = [json.loads(line)["job"] for line in (place / "one/results.jsonl").read_text().splitlines()]
    same = [contents(place / "single" / str(i), False) == {k: v for k, v in contents(place / "one" / name, False).items() if k.name != "result.json"}
            for i, name in enumerate(names) if (place / "one" / name).exists()]
    print(f"single commands as one batch: {sum(same)} of {len(same)}")
    random.seed(1)
    ended = 0
    for _ in range(kills):
        process = subprocess.Popen(batch("killed", "--jobs", "2"), env=environment, cwd=jobs.parent, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        time.sleep(random.uniform(0.05, 1.2))
        ended += process.poll() is None
        process.send_signal(random.choice([signal.SIGKILL, signal.SIGTERM, signal.SIGINT]))
        process.wait()
    subprocess.run(batch("killed"), env=environment, cwd=jobs.parent, check=False)
    print(f"killed {ended} times, as one batch: {contents(place / 'killed') == whole}, left over: {len(list(place.glob('killed/**/*.splatcut.*')))}")
    shutil.rmtree(place)


main()
