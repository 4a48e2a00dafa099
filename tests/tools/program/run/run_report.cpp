#include "tools/program/run/run_report.h"
#include "tools/program/text/wording.h"

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

namespace weft::tools {
namespace {

/// Figures that are all different, and come out even.
RunReport report() {
  RunReport report;
  report.scene = "somewhere";
  report.settings.tolerance = 0.0625;
  report.plan.dt = 0.5;
  RunSummary& summary = report.summary;
  summary.solver = Solver::yarn;
  summary.scheme = Scheme::paper;
  summary.isa = Isa::avx2;
  summary.threads = 3;
  summary.frames = 4;
  summary.total.status = Status::infeasible;
  summary.missed_frames = 37;
  summary.step_seconds = 1;
  summary.longest_step_seconds = 0.5;
  summary.cpu_seconds = 13;
  summary.solver_seconds = 15;
  summary.total.stage_seconds = {0.125, 0.375, 0.625, 0.875, 1.125, 1.375};
  summary.total.contact_ms = {2, 6, 1};
  summary.total.substeps = 22;
  summary.total.halvings = 7;
  summary.total.iterations = 20;
  summary.total.velocity_iterations = 12;
  summary.total.direction_updates = 36;
  summary.total.visits = 101;
  summary.total.corrections = 103;
  summary.total.scheme_fallbacks = 8;
  summary.total.contacts = 19;
  summary.total.body_contacts = 31;
  summary.total.body_work = 0.125;
  summary.total.friction_work = 0.0625;
  summary.total.contact_failures = 41;
  summary.total.zones = 43;
  summary.total.intersecting = 47;
  summary.total.self_contacts = 53;
  summary.total.tangled = 59;
  summary.total.max_error = 0.25;
  summary.max_strain = 0.125;
  summary.mean_max_strain = 0.03125;
  summary.rms_strain = 0.015625;
  summary.total.max_penetration = 0.75;
  summary.total.max_anchor_error = 0.5;
  summary.total.max_bending_error = 0.375;
  summary.energy_start = -1.5;
  summary.energy_end = -2.5;
  summary.total.pin_work = 0.875;
  summary.energy_gain = 0.25;
  summary.total.energy_lost = 0.4375;
  summary.mean_motion_error = 0.0078125;
  summary.total.motion_error = 0.046875;
  summary.lowest = -0.375;
  summary.state_hash = 0x0123456789abcdef;
  summary.bytes = 1600;
  summary.model.particles = 16;
  summary.model.constraints = 10;
  summary.model.compliant = 21;
  summary.model.membrane_elements = 37;
  summary.model.bending_elements = 23;
  summary.model.anchors = 31;
  summary.model.air_triangles = 29;
  summary.model.spheres = 17;
  report.plan.bodies = {{.shape = TriangleMesh{{}, {{0, 1, 2}, {0, 2, 3}}}}};
  return report;
}

TEST_CASE("the JSON has every figure, per frame where its name says so") {
  const Json expected = Json::parse(R"({
    "scene": "somewhere", "particles": 16, "constraints": 10, "spheres": 17,
    "springs": 21, "membrane_elements": 37, "bending_elements": 23, "anchors": 31, "seams": 0, "tethers": 0,
    "open_seams": 0, "max_seam_gap": 0, "seam_work": 0, "late_seams": 0, "held_apart": 0, "untangling_work": 0, "max_rail_gap": 0, "torn": 0, "law_error": 0, "air_triangles": 29, "rejected": 15,
    "max_error": 0.25,
    "solver": "auto", "solver_used": "yarn", "scheme": "paper", "scheme_fallbacks": 8,
    "backend": "simd", "anticipate_products": false, "isa": "avx2", "threads": 3,
    "dt": 0.5, "steps": 4, "frames": 4, "asleep_frames": 0, "substeps": 5.5, "halvings": 7,
    "tolerance": 0.0625, "iterations": 0, "status": "infeasible", "missed_frames": 37,
    "ms_per_frame": 250, "max_ms_per_frame": 500, "real_time_factor": 2,
    "max_strain": 0.125, "mean_max_strain": 0.03125, "rms_strain": 0.015625,
    "max_penetration": 0.75, "max_bending_error": 0.375, "max_anchor_error": 0.5, "max_contacts": 19,
    "bodies": 1, "body_triangles": 2, "body_contacts": 31, "body_work": 0.125,
    "friction_work": 0.0625, "contact_failures": 41, "zones": 43, "intersecting": 47,
    "self_contacts": 53, "tangled": 59,
    "iterations_per_step": 5, "velocity_iterations_per_step": 3, "direction_updates_per_step": 9,
    "visits": 101, "corrections": 103, "ns_per_constraint_iteration": 3125000,
    "energy_start": -1.5, "energy_end": -2.5, "pin_work": 0.875, "energy_gain": 0.25,
    "energy_lost": 0.4375, "motion_tolerance": 0, "motion_error": 0.0078125,
    "max_motion_error": 0.046875,
    "lowest_y": -0.375, "state_hash": "0123456789abcdef", "bytes_per_particle": 100,
    "stages": {"predict": 31.25, "find_contacts": 93.75, "solve_positions": 156.25,
               "commit": 218.75, "correct_velocities": 281.25, "report": 343.75},
    "contact_ms": {"find": 0.5, "sweep": 1.5, "verify": 0.25}})");
  const Json actual = to_json(report());
  for (const auto& [key, value] : expected.items()) {
    CAPTURE(key);
    CHECK(actual.value(key, Json()) == value);
  }
  CHECK(actual.size() == expected.size() + 1);
  CHECK(actual["peak_rss_mb"] > 1);
  CHECK(actual["peak_rss_mb"] < 2000);
}

TEST_CASE("bodies with a mass are listed where they end") {
  RunReport of_free = report();
  of_free.summary.free_bodies = {
      {.body = 2, .pose = {{1, 2, 3}, {0, 0, 1, 0}}, .centre = {1, -0.5, 4}}};
  CHECK(to_json(of_free)["free_bodies"] == Json::parse(R"([{"body": 2, "position": [1.0, 2.0, 3.0],
      "rotation": [0.0, 0.0, 1.0, 0.0], "centre": [1.0, -0.5, 4.0]}])"));
  const auto has = [&](const char* line) {
    return to_table(of_free).find(line) != std::string::npos;
  };
  CHECK(has("          1 with a mass, its centre at y -0.5 m in the end\n"));
  of_free.summary.free_bodies.push_back({.body = 3, .pose = {}, .centre = {0, 0.25, 0}});
  CHECK(has("          2 with a mass, their centres at y -0.5 m to 0.25 m in the end\n"));
}

TEST_CASE("the table has every figure too") {
  RunReport in_all = report();
  in_all.summary.scheme = Scheme::rattle;
  CHECK(to_table(in_all) ==
        "scene     somewhere: 16 particles, 10 constraints, 17 spheres\n"
        "material  21 springs, 37 triangles, 23 bending elements, 29 air triangles\n"
        "solver    auto (yarn), scheme rattle, backend simd, tolerance 6.25 %\n"
        "scheme    8 of 22 substeps left to scheme paper\n"
        "frames    4 of 0.5 s in 5.5 substeps each, 37 out of tolerance,\n"
        "          status infeasible\n"
        "time      250 ms per frame, 500 the longest, 2 times real time,\n"
        "          at max error of the law 25 %\n"
        "stages    predict 31.2, find_contacts 93.8, solve_positions 156, commit 219,\n"
        "          correct_velocities 281, report 344 ms at max error of the law 25 %\n"
        "strain    max 12.5 %, mean of the frames' max 3.12 %, rms 1.56 %\n"
        "contacts  0.75 m deepest penetration\n"
        "bodies    1 body, 31 contacts at most, 0.75 m deepest penetration,\n"
        "          0.0625 J by friction, 0.125 J by moved ones\n"
        "          0.5 ms per frame to find contacts, 1.5 in sweeps, 0.25 to verify\n"
        "crossings 41 crossings were stopped, 43 moved as if glued,\n"
        "          at most 47 could not be stopped in a frame\n"
        "anchors   31, 0.5 m beyond their limits at most\n"
        "work      5 iterations and 9 direction updates per step, 101 visits,\n"
        "          103 corrections\n"
        "energy    -1.5 J to -2.5 J, 0.875 J by moved pins, largest gain 0.25 J,\n"
        "          0.438 J lost\n"
        "state     0123456789abcdef, lowest y -0.375 m\n");
}

TEST_CASE("contacts of the cloth with itself are in the table where it has self-contact") {
  RunReport of_layers = report();
  CHECK(to_table(of_layers).find("layers") == std::string::npos);
  of_layers.plan.touches_itself = true;
  of_layers.plan.bodies.clear();
  CHECK(to_table(of_layers).find(
            "layers    53 contacts at most, 59 pairs tangled in the last frame\n"
            "          0.5 ms per frame to find contacts, 1.5 in sweeps, 0.25 to verify\n"
            "crossings ") != std::string::npos);
}

TEST_CASE("crossings are in the report where they were counted or stopped") {
  RunReport counted = report();
  CHECK_FALSE(to_json(counted).contains("intersections"));
  counted.summary.total.contact_failures = counted.summary.total.zones =
      counted.summary.total.intersecting = 0;
  CHECK(to_table(counted).find("crossings") == std::string::npos);
  counted.summary.intersections = 1;
  CHECK(to_json(counted)["intersections"] == 1);
  CHECK(to_table(counted).find("crossings 1 crossing of triangles at most in a frame\n") !=
        std::string::npos);
}

TEST_CASE("the report of a mesh says what it turned out to be") {
  RunReport of_mesh = report();
  CHECK_FALSE(to_json(of_mesh).contains("pieces"));
  of_mesh.mesh = MeshCounts{.pieces = 1};
  CHECK(to_table(of_mesh).find("mesh      1 piece\n") != std::string::npos);
  of_mesh.mesh = MeshCounts{.welded_vertices = 3,
                            .unused_vertices = 1,
                            .degenerate_faces = 2,
                            .double_faces = 7,
                            .non_manifold_edges = 1,
                            .pieces = 5,
                            .loose_pieces = 4};
  CHECK(to_table(of_mesh).find(
            "mesh      5 pieces, 4 on no pin, 3 vertices welded,\n"
            "          1 vertex in no face and no line, 2 faces without area, 7 faces twice,\n"
            "          used once, 1 edge of more than two faces\n") != std::string::npos);
  const Json json = to_json(of_mesh);
  CHECK(json["pieces"] == 5);
  CHECK(json["loose_pieces"] == 4);
  CHECK(json["welded_vertices"] == 3);
  CHECK(json["unused_vertices"] == 1);
  CHECK(json["degenerate_faces"] == 2);
  CHECK(json["non_manifold_edges"] == 1);
}

TEST_CASE("stretch of warp and weft stands beside shear where there is a fabric") {
  RunReport of_fabric = report();
  CHECK_FALSE(to_json(of_fabric).contains("max_shear"));
  CHECK(to_table(of_fabric).find("\nfabric") == std::string::npos);
  of_fabric.summary.fabric = FabricStrain{0.0625, 0.03125, 0.34};
  CHECK(to_table(of_fabric).find("fabric    warp 6.25 %, weft 3.12 %, shear 0.34 rad at most\n") !=
        std::string::npos);
  const Json json = to_json(of_fabric);
  CHECK(json["max_warp"] == 0.0625);
  CHECK(json["max_weft"] == 0.03125);
  CHECK(json["max_shear"] == 0.34);
}

TEST_CASE("a table tells of the work of pins where they did some") {
  RunReport at_rest = report();
  at_rest.summary.total.pin_work = 0;
  CHECK(to_table(at_rest).find("J to -2.5 J, largest gain 0.25 J, ") != std::string::npos);
}

TEST_CASE("a table tells of the motion where small steps estimated its error") {
  RunReport of_small_steps = report();
  CHECK(to_table(of_small_steps).find("motion") == std::string::npos);
  of_small_steps.summary.solver = Solver::small_steps;
  of_small_steps.settings.motion_tolerance = 0.0625;
  CHECK(to_table(of_small_steps).find("tolerance 6.25 % and 0.0625 m/s\n") != std::string::npos);
  CHECK(to_table(of_small_steps)
            .find("motion    0.00781 m/s away from the true one by estimate, 0.0469 at most\n") !=
        std::string::npos);
}

TEST_CASE("a table of rigid cloth is about strain, and says nothing of a material") {
  RunReport rigid = report();
  rigid.summary.model.compliant = rigid.summary.model.membrane_elements =
      rigid.summary.model.bending_elements = 0;
  rigid.summary.model.air_triangles = 0;
  CHECK(to_table(rigid).find("at max strain 25 %") != std::string::npos);
  CHECK(to_table(rigid).find("material") == std::string::npos);
}

TEST_CASE("factors have three digits, and all of those before the point") {
  CHECK(factor_text(0.12345) == "0.123");
  CHECK(factor_text(12.345) == "12.3");
  CHECK(factor_text(999) == "999");
  CHECK(factor_text(2083.4) == "2083");
}

TEST_CASE("substeps are those asked for, or the mean of those chosen") {
  RunReport asked = report();
  asked.settings.substeps = 8;
  CHECK(to_json(asked)["substeps"] == 8);
  asked.settings.substeps = kAutomaticSubsteps;
  CHECK(to_json(asked)["substeps"] == 5.5);
}

TEST_CASE("the reference backend is scalar and has one thread") {
  RunReport on_reference = report();
  CHECK(to_json(on_reference)["threads"] == 3);
  CHECK(to_json(on_reference)["isa"] == "avx2");
  on_reference.settings.backend = Backend::reference;
  CHECK(to_json(on_reference)["threads"] == 1);
  CHECK(to_json(on_reference)["isa"] == "scalar");
}

TEST_CASE("a table says which solver was chosen, and of contacts where there are spheres") {
  RunReport chosen = report();
  chosen.summary.model.spheres = 0;
  CHECK(to_table(chosen).find("auto (yarn)") != std::string::npos);
  CHECK(to_table(chosen).find("\ncontacts ") == std::string::npos);
  chosen.summary.model.spheres = 1;
  chosen.settings.solver = Solver::direct;
  chosen.settings.iterations = 3;
  CHECK(to_table(chosen).find("auto") == std::string::npos);
  CHECK(to_table(chosen).find("3 iterations per substep") != std::string::npos);
  CHECK(to_table(chosen).find("deepest penetration") != std::string::npos);
}

}  // namespace
}  // namespace weft::tools
