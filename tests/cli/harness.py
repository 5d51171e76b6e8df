"""Running burin and judging what it did. Shared by the scripts of this folder."""

import argparse
import os
import resource
import shutil
import subprocess
import sys
import tempfile
import time

SKIPPED = 77  # CTest's SKIP_RETURN_CODE for these tests


class Outcome:
    """What one run of the program gave."""

    def __init__(self, arguments, status, stdout, stderr, seconds):
        self.arguments, self.status, self.seconds = arguments, status, seconds
        self.stdout, self.stderr = stdout, stderr

    def __str__(self):
        command = " ".join(self.arguments)
        return f"$ burin {command}\nstatus {self.status} after {self.seconds:.1f} s\n{self.stdout}{self.stderr}"


def run(burin, arguments, timeout=120, folder=None, environment=None, stdout=subprocess.PIPE):
    """Runs burin with a limit of time; a status of 'timeout' says that the limit was passed. What goes to a `stdout` of
    the caller's is not in the outcome."""
    begun = time.monotonic()
    try:
        done = subprocess.run([burin] + arguments, stdin=subprocess.DEVNULL, stdout=stdout,
                              stderr=subprocess.PIPE, timeout=timeout, cwd=folder,
                              env=dict(os.environ, **(environment or {})), check=False)
        status, out, err = done.returncode, done.stdout, done.stderr
    except subprocess.TimeoutExpired as expired:
        status, out, err = "timeout", expired.stdout or b"", expired.stderr or b""
    text = [(part or b"").decode("utf-8", "replace") for part in (out, err)]
    return Outcome(arguments, status, *text, time.monotonic() - begun)


def read_arguments():
    """The command line of a test that needs nothing but the program."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--burin", required=True)
    return parser.parse_args()


class Verdicts:
    """Counts what failed and prints it at once."""

    def __init__(self):
        self.checked, self.failed = 0, 0

    def expect(self, condition, what, outcome=""):
        self.checked += 1
        if not condition:
            self.failed += 1
            print(f"FAILED: {what}\n{outcome}\n", flush=True)
        return condition

    def finish(self):
        print(f"{self.checked} checks, {self.failed} failed", flush=True)
        sys.exit(1 if self.failed else 0)


def one_line_error(outcome):
    """stderr is exactly one line of the documented form."""
    command = outcome.arguments[0] if outcome.arguments else ""
    names = [f"burin {command}: error: ", "burin: error: "]
    return outcome.stderr.count("\n") == 1 and any(outcome.stderr.startswith(name) for name in names)


def skip(reason):
    print(f"SKIPPED: {reason}", flush=True)
    sys.exit(SKIPPED)


def shared_data(arguments, folder):
    """The folder of ../shared/data that is asked for; skips where it is absent."""
    path = os.path.join(arguments.shared, folder)
    if not os.path.isdir(path):
        skip(f"{path} is not here")
    return path


class Scratch:
    """A folder that is gone afterwards."""

    def __enter__(self):
        self.path = tempfile.mkdtemp(prefix="burin_cli_")
        return self.path

    def __exit__(self, *_):
        shutil.rmtree(self.path, ignore_errors=True)


def limit_memory(bytes_allowed):
    """Of the programs started from here."""
    resource.setrlimit(resource.RLIMIT_AS, (bytes_allowed, bytes_allowed))
