"""Every command of the README that runs the program is run, as it stands there"""
import os, re, shlex, subprocess

from abut import PROGRAM, ROOT


def commands():
    with open(os.path.join(ROOT, "README.md")) as f:
        blocks = re.findall(r"^```\n(.*?)^```", f.read(), re.M | re.S)
    return [line.split("#")[0].strip() for block in blocks for line in block.splitlines() if "build/bin/abut" in line]


def test_every_command_ends_well():
    assert len(commands()) >= 2, "the README shows no command"
    for line in commands():
        words = [PROGRAM if word == "build/bin/abut" else word for word in shlex.split(line)]
        done = subprocess.run(words, cwd=ROOT, capture_output=True, text=True)
        assert done.returncode == 0, f"{line}\n{done.stdout}{done.stderr}"
