"""The official conformance suite, on both revisions: on coin-server, and on the same serving code with its fixtures."""

import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

from trial import homes
from trial.client import Era
from trial.places import REPOSITORY, node, program
from trial.table import aligned

SUITE = "@modelcontextprotocol/conformance/dist/index.js"
BASELINES = REPOSITORY / "clients/conformance"

# How the suite names what it did not expect: a scenario, or one check of it.
NAMED = re.compile(r"^\s*✗ ([\w-]+)", re.MULTILINE)

# How the suite sums a scenario up.
SUMMARY = re.compile(r"^[✓✗⚠] ([\w-]+): (\d+) passed, (\d+) failed", re.MULTILINE)


def judged(url: str, era: Era, baseline: Path | None, folder: Path) -> tuple[bool, str]:
    """Whether the suite is content with a server, and what it says."""
    command = [*node(SUITE), "server", "--url", url, "--requirements", era.version, "--output-dir", folder]
    if baseline is not None:
        command += ["--expected-failures", baseline]
    run = subprocess.run(command, capture_output=True, text=True)
    return run.returncode == 0, run.stdout + run.stderr


def complaint(said: str, results: Path) -> str:
    """What was not expected, with what the suite says of every check in it that failed."""
    _, _, verdict = said.partition("(not in baseline)")
    unexpected = set(NAMED.findall(verdict or said))
    lines = [said[said.rfind("=== SUMMARY ===") :]]
    for path in sorted(results.glob("*/checks.json")):
        scenario = path.parent.name.removeprefix("server-").rpartition("-20")[0]
        failed = [check for check in json.loads(path.read_text()) if check["status"] in ("FAILURE", "WARNING")]
        for check in failed if scenario in unexpected else []:
            lines.append(f"{scenario}:{check['id']}: {check.get('errorMessage')}")
    return "\n".join(lines)


def main() -> int:
    rows, complaints = [], []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        home = homes.small_house(folder)
        subjects = {
            "coin-server": [program("coin-server"), "--db", home, "--http", "127.0.0.1:0"],
            "conformance-server": [program("conformance-server"), "127.0.0.1:0"],
        }
        for subject, command in subjects.items():
            with homes.serving(command) as url:
                for era in Era:
                    baseline = BASELINES / f"{subject}-{era.version}.yml"
                    baseline = baseline if baseline.exists() else None
                    results = folder / subject / era.version
                    content, said = judged(url, era, baseline, results)
                    scenarios = SUMMARY.findall(said)
                    passed = sum(failed == "0" for _, _, failed in scenarios)
                    checks = sum(int(passes) for _, passes, _ in scenarios)
                    verdict = "as expected" if content else "NOT AS EXPECTED"
                    rows.append([subject, era.version, f"{passed} of {len(scenarios)}", str(checks), verdict])
                    if not content:
                        complaints.append(f"{subject}, {era.version}\n{complaint(said, results)}")
    print(aligned(["server", "revision", "scenarios passed", "checks passed", "verdict"], rows))
    for text in complaints:
        print(f"\n{text}")
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
