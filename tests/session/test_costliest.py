from __future__ import annotations

TESTS = """
import subprocess, sys, time

def work(seconds):
    end = time.process_time() + seconds
    while time.process_time() < end:
        pass

def test_works():
    work(0.08)

def test_waits():
    time.sleep(0.08)

def test_starts_a_process():
    subprocess.run([sys.executable, "-c", "import time\\nwhile time.process_time() < 0.15: pass"], check=True)
"""


def test_a_file_has_the_processor_time_of_each_test_and_of_what_it_starts(run_tests, tmp_path):
    code, shown = run_tests(TESTS, "-n", "1", "--costs", str(tmp_path / "costs.txt"), plugin="costliest")
    assert code == 0, shown
    assert "Processor time" not in shown
    rows = [line.split("\t") for line in (tmp_path / "costs.txt").read_text("utf-8").splitlines()]
    costs = {name.partition("::")[2]: float(cost) for cost, name in rows}
    assert list(costs) == ["test_starts_a_process", "test_works", "test_waits"]
    assert costs["test_starts_a_process"] >= 0.14
    assert costs["test_works"] >= 0.07
    assert costs["test_waits"] < 0.05


def test_a_long_run_names_the_files(run_tests):
    long = TESTS + "\nimport costliest\ncostliest.LONG = 0.1\n"
    code, shown = run_tests(long, plugin="costliest")
    assert code == 0, shown
    said = shown.partition("Processor time: ")[2]
    assert " s; most of it" in said, shown
    assert " s  test_given.py" in said
