"""Every phase of a run is a stage of PETSc's log, with the events of its own and of no other"""
import os, re, tempfile

from abut import ROOT, run

SCENE = os.path.join(ROOT, "examples", "studies", "shares", "layers_tol.yml")
EVENT = re.compile(r"^(\w+) +(\d+) 1\.0 ", re.M)


def stages(log):
    """Of -log_view: events of every stage, and its reductions"""
    table = log[log.index("Summary of Stages") : log.index("See the 'Profiling' chapter")]
    reductions = {name: float(count) for name, count in re.findall(r"^ *\d+: +(\S[^:]*): .* (\S+) +\S+%\s*$", table, re.M)}
    parts = re.split(r"^--- Event Stage \d+: (.*)$", log[: log.index("Object Type")], flags=re.M)
    return {name.strip(): dict(EVENT.findall(text)) for name, text in zip(parts[1::2], parts[2::2])}, reductions


def test_events_are_in_the_stage_of_their_phase():
    with tempfile.TemporaryDirectory() as folder:
        log = os.path.join(folder, "log")
        record = run(SCENE, "-scene_tol 0.05", f"-log_view :{log} -output {folder}/fields.xdmf -checkpoint {folder}/saved", ranks=2)
        with open(log) as f:
            found, reductions = stages(f.read())
    assert set(found) - {"Unknown"} == {"Main Stage", "Set-up", "Sweeps", "Estimate", "Adapt", "Output"}, found
    cycles, sweeps = record["cycles"], record["sweeps"]
    own = {
        "Set-up": {"AbutBodyAssemble": 2 * cycles, "AbutPairSetUp": cycles, "AbutCheckpoint": cycles - 1},
        "Sweeps": {"AbutSweep": sweeps, "AbutBodySolve": 2 * sweeps},
        "Estimate": {"AbutEstimate": None, "AbutMark": None},  # the last mesh may be solved further, and estimated again
        "Adapt": {"AbutMeshAdapt": 2 * (cycles - 1)},
        "Output": {"AbutWriteFields": cycles},
    }
    for stage, events in own.items():
        for name, count in events.items():
            at = {place: int(there[name]) for place, there in found.items() if name in there}
            assert at == {stage: count or at.get(stage)} and all(at.values()), (stage, name, count, at)
    assert reductions["Main Stage"] < 0.02 * sum(reductions.values()) and all(reductions[stage] > 0 for stage in own), reductions
