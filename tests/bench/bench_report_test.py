"""What tests/bench/run makes of the programs' reports, and what tests/bench/compare says of two of them."""
import importlib.machinery
import importlib.util
import json
import os
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
FOLDER = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, FOLDER)
import bench_report  # noqa: E402

_loader = importlib.machinery.SourceFileLoader("compare", os.path.join(FOLDER, "compare"))
compare = importlib.util.module_from_spec(importlib.util.spec_from_loader("compare", _loader))
_loader.exec_module(compare)


def repetition(name, ms, index, **more):
    """As Google Benchmark 1.7 writes one."""
    return {"name": name, "run_name": name, "run_type": "iteration", "family_index": more.pop("family", 0),
            "per_family_instance_index": 0, "repetitions": 3, "repetition_index": index, "threads": 1, "iterations": 7,
            "real_time": ms, "cpu_time": 1.0, "time_unit": "ms", **more}


def results(times_ms, name="filter/threads:2/manual_time", isa="avx2"):
    return {"machine": {"processor": "P", "processors": 2, "caches": []}, "commit": "c", "date": "d",
            "programs": {"kernel_bench": {"isa": isa}},
            "benchmarks": {name: {"program": "kernel_bench", "times_ns": [t * 1e6 for t in times_ms], "counters": {}}}}


class Merge(unittest.TestCase):
    def merge(self, runs):
        report = {"context": {"date": "today", "num_cpus": 2, "caches": [], "isa": "avx2"}, "benchmarks": runs}
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "kernel_bench.json")
            with open(path, "w", encoding="utf-8") as file:
                json.dump(report, file)
            out = os.path.join(folder, "bench.json")
            bench_report.write(bench_report.merge([path], "abc"), out)
            self.assertEqual(sorted(os.listdir(folder)), ["bench.json", "kernel_bench.json"])
            return bench_report.read_results(out)

    def test_keeps_repetitions_and_takes_the_median_of_counters(self):
        merged = self.merge([repetition("a", 3.0, 0, **{"ns/px": 5}), repetition("a", 2.0, 1, **{"ns/px": 9}),
                             repetition("a", 4.0, 2, **{"ns/px": 6}),
                             {"name": "a_median", "run_name": "a", "run_type": "aggregate", "real_time": 99, "time_unit": "ms"}])
        self.assertEqual(merged["benchmarks"]["a"]["times_ns"], [3e6, 2e6, 4e6])
        self.assertEqual(merged["benchmarks"]["a"]["counters"], {"ns/px": 6})
        self.assertEqual(merged["commit"], "abc")
        self.assertEqual(merged["programs"]["kernel_bench"], {"isa": "avx2"})
        self.assertIn("2 ms", bench_report.table(merged))

    def test_brings_what_ran_in_random_order_into_the_programs_order(self):
        merged = self.merge([repetition("second", 1.0, 0, family=1), repetition("first", 1.0, 0, family=0)])
        self.assertEqual(list(merged["benchmarks"]), ["first", "second"])

    def test_refuses_what_is_no_report(self):
        with self.assertRaisesRegex(bench_report.WrongFile, "README.md"):
            bench_report.read_results(os.path.join(FOLDER, "README.md"))
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "other.json")
            with open(path, "w", encoding="utf-8") as file:
                json.dump({"benchmarks": {}}, file)  # as a program's own report, which has a context
            with self.assertRaisesRegex(bench_report.WrongFile, "other.json: it is not a bench.json"):
                bench_report.read_results(path)


class Compare(unittest.TestCase):
    def test_marks_what_is_beyond_the_noise_of_both(self):
        quiet, slower, noisy = results([10, 10.1, 10.2]), results([11, 11.1, 11.2]), results([11, 12.5, 14])
        text, is_slower = compare.compare(quiet, slower)
        self.assertTrue(is_slower)
        self.assertIn("1.10  SLOWER", text)
        self.assertIn("filter/threads:2 ", text)
        self.assertIn("faster", compare.compare(slower, quiet)[0])
        self.assertFalse(compare.compare(quiet, noisy)[1])

    def test_finds_no_change_in_equal_times(self):
        text, is_slower = compare.compare(results([10, 11]), results([10.2, 11]))
        self.assertFalse(is_slower)
        self.assertNotIn("faster", text)

    def test_shows_what_only_one_has_and_what_is_not_alike(self):
        text, _ = compare.compare(results([10], name="old"), results([10], name="new", isa="sse4"))
        self.assertIn("NOT ALIKE: isa of kernel_bench: avx2 and sse4", text)
        self.assertRegex(text, r"old +10 ms +-")
        self.assertRegex(text, r"new +- +10 ms")


if __name__ == "__main__":
    unittest.main()
