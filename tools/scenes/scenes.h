/// The built-in scenes: the paper's three, three hard ones, two that are like a game's, some of a
/// material, some that are sewn, and some that touch themselves. Exact definitions, SI units.
///
/// Cloth scenes are N x N particles over 1 m x 1 m, particle (i, j) has the number i * N + j,
/// spacing L = 1/(N-1), total mass 1 kg, gravity (0, -10, 0); constraints join grid neighbours
/// ("structural" edges) and, with Options::diagonals, opposite corners of every cell (ropes of
/// length sqrt(2) L); those between two fixed particles are left out. All start at rest, every edge
/// at its rest length; particles of the cloth have radius 0.
///
/// With Options::material a cloth is what cloth_from_mesh makes of its faces: its edges are
/// springs, it bends, and its mass is that of its density. At rest it is flat, also where it starts
/// folded.
///
/// hang         (i, j) at (i L, 0, j L); the column i = 0 is fixed.
/// hang_sphere  The same, and a fixed sphere at (0.5, -0.6, 0.5), radius 0.25.
/// sphere_drop  The rows j = 0 and j = N-1 are fixed, 1 - slack apart along z; between them the
///              sheet sags as a circular arc of chords of length L. A free sphere of radius 0.15,
///              its lowest point 0.3 above the middle of the sheet.
/// corners      N odd; (i, j) at (i L, -sqrt(1 - 0.81) min(j L, 1 - j L), 0.9 j L): folded along
///              its middle row. (0, 0) and (0, N-1) are fixed.
/// banner       (i, j) at (0, -i L, j L): upright. (0, 0) and (0, N-1) are fixed, as far apart as
///              in it, so that its upper edge can only hang by the strain that is tolerated.
/// four_pins    (i, j) at (i L, 0, j L); its four corners are fixed, as far apart as in it.
/// cape         The irregular mesh of triangles and quads of irregular_mesh.h, N x N points in an
///              order of chance: no grid. Its faces' edges are constraints of the length they have.
///              Fixed is what has x < 1.19 L, an uneven row (N = 120: x < 0.01, 210 particles).
///              Points that holes leave in no face are particles only without a material.
/// chain        Particles of 1 kg in a line along x, 0.01 apart; the first is fixed, the last has
///              end_mass. It has no material.
/// flag         (i, j) at (i L, -j L, 0), of cotton if no material is given; the column i = 0 is
///              fixed, in a wind of (8, 0, 2) m/s.
/// drape        (i, j) at (i L, 0, j L), of the same, 1 cm above a fixed sphere of radius 0.3 below
///              the middle of the sheet.
/// tunic        A front and a back of irregular triangles, body and sleeves of one piece, sewn
///              along shoulders, sleeves and sides (garments.cpp has the pattern, 0.9 m wide and
///              0.7 long). Vertices are about 1/(N-1) m apart. It hangs from 8 cm of each shoulder;
///              of cotton if no material is given. It has self-contact.
/// table        (i, j) at (i L, 0.001, j L), of cotton if no material is given: a sheet that
///              lies on the top of a box of which it covers 0.4 m, and slides off its edge;
///              friction 0.2.
/// cushion      (i, j) at (i L, 0, j L), of the same; its border is fixed. A ball of radius 0.15 is
///              pressed 6 cm into it, rolls 0.2 m along x, and slides back; friction 0.4.
/// mannequin    The tunic, worn by a body of capsules that begins to walk after a second, 1 m/s.
/// mannequin_mesh  The same on triangle meshes of these capsules, 24 triangles around each.
/// skirt        Likewise: a front and a back that make up a cone, 0.45 m long; its waist is fixed.
///
/// Those that follow have self-contact, and are of cotton if no material is given.
///
/// stack        Five level sheets 1 cm above each other and a floor, each turned by 0.1 rad against
///              the one under it.
/// fold         A sheet in four layers, like a letter: three half circles of a radius of 2 cm join
///              them. It falls from 5 cm on a floor.
/// curtain      The table, 0.6 m above a floor; its friction is 0.03, so that the whole sheet
/// slides off. twist        N rows along x, of as many vertices as make it 0.2 m wide. In six
/// seconds its ends
///              turn by three turns against each other, and come nearer by 0.2 m.
/// ribbon       2 m long and 0.125 m wide, upright, with waves of 5 mm. Its upper end is lowered in
///              five seconds, from 2.02 m above the floor to 0.12 m.
/// funnel       What is within 10 cm of the middle of a level sheet is drawn down by a metre in
///              six seconds, through a ring of triangles that is 0.28 m wide inside; friction 0.1.
/// outfit       The tunic of the mannequin, and over it a wide skirt of 0.4 m whose waist goes with
///              the body.
#pragma once

#include <weft/mesh.h>

#include <span>
#include <string_view>

#include "tools/scenes/scene.h"

namespace weft::scenes {

struct BuiltIn {
  std::string_view name;
  std::string_view summary;
  bool is_fabric = false;  ///< it always has a material
};

/// hang, hang_sphere, sphere_drop, corners, banner, four_pins, cape, chain, flag, drape, table,
/// cushion, tunic, skirt, mannequin, mannequin_mesh, stack, fold, curtain, twist, ribbon, funnel,
/// outfit.
std::span<const BuiltIn> list();

/// An unknown name or an option out of range is an error.
Result<Scene> make_scene(std::string_view name, const Options& options);
/// Its description alone.
Result<SceneDescription> make(std::string_view name, const Options& options);

}  // namespace weft::scenes
