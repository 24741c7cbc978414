"""examples/troubleshooting: every broken scene of its page says what the page says, and every mend ends well"""

import os, re, shlex

from abut import ROOT, run

FOLDER = os.path.join(ROOT, "examples", "troubleshooting")
SCENE = os.path.join(FOLDER, "scene.yml")


def test_the_scene_itself():
    assert run(SCENE)["verdict"] == "converged"


def test_what_the_page_says():
    with open(os.path.join(FOLDER, "README.md")) as f:
        parts = re.findall(r"```\nabut scene.yml (.*)\n```\n> (.*)\n\nExit status (\d). The mend: `(.*?)`;", f.read())
    assert len(parts) >= 10, parts
    for broken, line, status, mend in parts:
        record = run(SCENE, *shlex.split(broken), expect=int(status))
        said = record.stderr.strip() if status == "1" else record.stdout.strip().splitlines()[-1]
        assert said == line, (broken, said, line)
        assert run(SCENE, *shlex.split(mend))["verdict"] == "converged", mend
