#!/usr/bin/env python3
"""Prints what `bench --json FILE` wrote as tables in Markdown: scenes, drags and bars.

    python3 docs/lab/tables.py docs/lab/runs/2026-11-22.json
"""
import json
import sys


def table(heads, rows):
    print("| " + " | ".join(heads) + " |")
    print("|" + "---|" * len(heads))
    for row in rows:
        print("| " + " | ".join("–" if cell is None else str(cell) for cell in row) + " |")
    print()


def times(scene, sweep):
    """How many times longer a sweep took than the whole of ours; ~ where a slab of it was scaled up."""
    if not sweep.get("seconds"):
        return None
    ratio = sweep.get("over_total") or sweep["seconds"] / scene["total_seconds"]
    return f"{'~' if sweep.get('scaled_up') else ''}{ratio:.1f}"


def openvdb(scene, hand):
    peer = scene["peers"].get("openvdb")
    if not peer:
        return None
    if hand:
        ratio = peer.get("by_hand_over_total") or peer["by_hand_seconds"] / scene["total_seconds"]
    else:
        ratio = (peer["sample_seconds"] + peer["mesh_seconds"]) / scene["total_seconds"]
    return f"{ratio:.1f}"


def scene_row(s):
    stages = s["stages"]
    vtk = s["peers"].get("vtk_flying_edges", {}).get("mesh_seconds")
    bytes_each = s.get("bytes_per_triangle") or round(s["peak_bytes"] / s["triangles"])
    return [s["scene"], s["resolution"], s["tape_length"], f"{s['total_seconds']:.4f}", f"{stages['subdivide_seconds']:.4f}",
            f"{stages['sample_seconds']:.4f}", f"{stages['polygonize_seconds']:.4f}", f"{s['sample_over_least']:.1f}",
            f"{s['polygonize_over_write']:.1f}", s["swept_by"].split("-")[0], times(s, s["dense"]), times(s, s["fused"]),
            times(s, s["fused_over_bounds_alone"]), openvdb(s, False), openvdb(s, True), vtk and f"{vtk / s['total_seconds']:.1f}",
            s["triangles"], f"{s['ns_per_triangle']:.1f}", f"{s['point_evaluations_per_surface_cell']:.2f}", bytes_each]


def stages(seconds):
    return seconds and ", ".join(f"{name.removesuffix('_seconds')} {value:.4f}" for name, value in seconds.items())


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    with open(sys.argv[1], encoding="utf-8") as file:
        run = json.load(file)
    limits = run["limits"]
    print(f"{run['threads']} threads, {limits['instruction_set']}: {limits['fused_gflops']:.0f} Gflop/s fused, "
          f"write {limits['write_gb_per_second']:.1f} GB/s, fresh pages {limits['fresh_write_gb_per_second']:.1f} GB/s, "
          f"copy {limits['copy_gb_per_second']:.1f} GB/s\n")
    table(["scene", "res", "tape", "total s", "descend", "sample", "join", "s/op", "j/wr", "swept by", "dense ×", "fused ×",
           "tight ×", "OpenVDB ×", "by hand ×", "VTK ×", "triangles", "ns/tri", "ev/cell", "B/tri"], map(scene_row, run["scenes"]))
    if run.get("drags"):
        table(["scene", "res", "parameter", "drag s", "its stages", "full s", "its stages", "share", "blocks"],
              ([d["scene"], d["resolution"], d["parameter"], f"{d['drag_seconds']:.4f}", stages(d.get("drag_stages")),
                f"{d['full_seconds']:.4f}", stages(d.get("full_stages")), f"{d['share']:.3f}",
                f"{d['blocks_made']} of {d['blocks_made'] + d['blocks_kept']}"] for d in run["drags"]))
    if run.get("bars"):
        table(["bar", "asked for", "measured", "", "remark"],
              ([b["what"], f"≥ {b['at_least']:g}" if "at_least" in b else f"≤ {b['at_most']:g}", f"{b['measured']:.4g}",
                "" if b["reached"] else "short", b["remark"]] for b in run["bars"]))


main()
