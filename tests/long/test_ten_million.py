"""One body of a million unknowns on two ranks, and of ten million on request, within 22 GB: bytes, iterations, energy; limit: 7200 s

The energy is that of a square under uniform pressure: p^2 (1 - nu^2)/(2 E) in plane strain."""
import os, unittest

from abut import run

E, NU, P = 2.1e5, 0.3, 100.0
BODY = f"""-scene_bodies a -a_mesh_box 0,0,1,1 -a_material_young {E} -a_material_poisson {NU} -a_bc_left_u1 0 -a_bc_bottom_u2 0 -a_bc_top_t2 {-P}
    -a_ksp_type cg -a_pc_type hypre -a_ksp_rtol 1e-8"""
BYTES = 1700  # an unknown: 1,530 to 1,590 were measured, some 550 of the mesh, 330 of the matrices, 560 of the multigrid


def solved(side):
    record = run(None, *BODY.split(), f"-a_mesh_cells {side},{side}", ranks=2, limit=7000)
    print(f"{record['unknowns']} unknowns, {record['body.a.ksp_its']} iterations, {record['memory.peak'] / record['unknowns']:.0f} bytes an unknown")
    assert record["unknowns"] == 2 * (side + 1) ** 2 and record["verdict"] == "converged"
    assert abs(record["energy.strain"] / (P**2 * (1 - NU**2) / (2 * E)) - 1) < 1e-7, record["energy.strain"]
    assert record["body.a.ksp_its"] <= 30
    return record["memory.peak"] / record["unknowns"]


def available():
    """Bytes that the machine could give"""
    if not os.path.exists("/proc/meminfo"):
        return 0
    with open("/proc/meminfo") as f:
        return 1024 * next(int(line.split()[1]) for line in f if line.startswith("MemAvailable"))


def test_a_million_unknowns_of_one_body_take_few_bytes():
    assert solved(707) <= BYTES


def test_ten_million_unknowns_of_one_body_fit():
    if not os.environ.get("ABUT_TEN_MILLION"):
        raise unittest.SkipTest("takes 16 GB and minutes; asked for by ABUT_TEN_MILLION=1 make test-long T=ten_million")
    if available() < 23e9:
        raise unittest.SkipTest(f"{available() / 1e9:.1f} GB are free, and 23 should be")
    bytes_ = solved(2236)
    assert bytes_ * 2 * 2237**2 <= 22e9 and bytes_ <= BYTES
