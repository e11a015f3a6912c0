"""Reads and writes bench.json: what all benchmark programs measured in one run.

  bench_report.py merge OUT COMMIT FILE...   one file of those that the programs wrote
  bench_report.py table FILE                 a table for people

{"machine": {...}, "commit": ..., "date": ..., "programs": {program: {"isa": ..., ...}},
 "benchmarks": {name: {"program": ..., "times_ns": [...], "counters": {...}}}}
"""
import json
import os
import platform
import statistics
import sys

_NS = {"ns": 1, "us": 1e3, "ms": 1e6, "s": 1e9}
# Fields of Google Benchmark's own; all other numbers of a benchmark are its counters.
_OWN = {"name", "run_name", "run_type", "repetitions", "repetition_index", "threads", "iterations", "real_time", "cpu_time",
        "time_unit", "family_index", "per_family_instance_index", "aggregate_name", "aggregate_unit", "error_occurred",
        "error_message", "label"}


class WrongFile(Exception):
    """A file that is not what it should be; the text says where and what."""


def _read(path):
    try:
        with open(path, encoding="utf-8") as file:
            return json.load(file)
    except (OSError, ValueError) as error:
        raise WrongFile(f"{path}: {error}") from error


def read_results(path):
    """What merge() wrote."""
    results = _read(path)
    if not isinstance(results, dict) or not {"machine", "commit", "date", "programs", "benchmarks"} <= results.keys():
        raise WrongFile(f"{path}: it is not a bench.json, as tests/bench/run writes it")
    return results


def best_ns(benchmark):
    """The smallest time: to it the machine's other work has added least."""
    return min(benchmark["times_ns"])


def noise(benchmark):
    """How far half of the times lie above the smallest, as a fraction."""
    return statistics.median(benchmark["times_ns"]) / best_ns(benchmark) - 1


def _machine(context):
    caches = [f"L{c['level']} {c['type'].lower()} {c['size'] // 1024} KiB" for c in context.get("caches", [])]
    model = ""
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as file:
            model = next((line.split(":", 1)[1].strip() for line in file if line.startswith("model name")), "")
    except OSError:
        pass
    return {"processor": model or platform.processor(), "processors": context.get("num_cpus"), "caches": caches,
            "load_before": context.get("load_avg"), "system": platform.platform()}


def _place(run):
    """Of a benchmark within its program, whatever the order in which they were run."""
    return run.get("family_index", 0), run.get("per_family_instance_index", 0), run.get("repetition_index", 0)


def merge(paths, commit):
    """The results of several programs as one."""
    merged = {"machine": None, "commit": commit, "date": None, "programs": {}, "benchmarks": {}}
    for path in paths:
        program = os.path.splitext(os.path.basename(path))[0]
        report = _read(path)
        context = report["context"]
        merged["machine"] = merged["machine"] or _machine(context)
        merged["date"] = merged["date"] or context["date"]
        merged["programs"][program] = {key: context[key] for key in ("isa", "frame") if key in context}
        for run in sorted(report["benchmarks"], key=_place):
            if run.get("run_type") != "iteration" or run.get("error_occurred"):
                continue
            entry = merged["benchmarks"].setdefault(
                run["run_name"], {"program": program, "times_ns": [], "counters": {}})
            entry["times_ns"].append(run["real_time"] * _NS[run["time_unit"]])
            for key, value in run.items():
                if key not in _OWN and isinstance(value, (int, float)):
                    entry["counters"].setdefault(key, []).append(value)
    for entry in merged["benchmarks"].values():
        entry["counters"] = {key: statistics.median(values) for key, values in entry["counters"].items()}
    return merged


def write(results, path):
    """Beside the file, then renamed, so that a file that is there is whole."""
    part = f"{path}.part"
    with open(part, "w", encoding="utf-8") as file:
        json.dump(results, file, indent=1)
        file.write("\n")
    os.replace(part, path)


def duration(ns):
    """'12.3 ms'"""
    for unit in ("ns", "us", "ms"):
        if ns < 1000:
            return f"{ns:.3g} {unit}"
        ns /= 1000
    return f"{ns:.3g} s"


def columns(rows):
    """Rows of texts below each other, the first column to the left and the others to the right."""
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    return "\n".join("  ".join(text.ljust(width) if i == 0 else text.rjust(width)
                               for i, (text, width) in enumerate(zip(row, widths))).rstrip() for row in rows)


def short_name(name):
    """Without what Google Benchmark adds about how it measured."""
    return "/".join(part for part in name.split("/")
                    if part not in ("manual_time", "real_time") and not part.startswith("iterations:"))


def table(results):
    """For people: a block for each program, a column for each of its counters."""
    machine = results["machine"]
    text = [f"{machine['processor']}, {machine['processors']} processors, {', '.join(machine['caches'])}",
            f"commit {results['commit']}, {results['date']}"]
    for program, about in results["programs"].items():
        own = {name: entry for name, entry in results["benchmarks"].items() if entry["program"] == program}
        if not own:
            continue
        counters = list(dict.fromkeys(key for entry in own.values() for key in entry["counters"]))
        rows = [["", "best", "median"] + counters]
        for name, entry in own.items():
            best = best_ns(entry)
            rows.append([short_name(name), duration(best), f"+{100 * noise(entry):.0f}%"] +
                        [f"{entry['counters'][key]:.3g}" if key in entry["counters"] else "" for key in counters])
        text += ["", program + "".join(f", {key} {value}" for key, value in about.items()), columns(rows)]
    return "\n".join(text)


def main(arguments):
    if len(arguments) >= 4 and arguments[0] == "merge":
        write(merge(arguments[3:], arguments[2]), arguments[1])
    elif len(arguments) == 2 and arguments[0] == "table":
        print(table(read_results(arguments[1])))
    else:
        raise WrongFile("usage: bench_report.py merge OUT COMMIT FILE... | table FILE")


if __name__ == "__main__":
    try:
        main(sys.argv[1:])
    except WrongFile as wrong:
        sys.exit(f"error: {wrong}")
