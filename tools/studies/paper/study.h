/// The measurements of the paper's section 5: which runs there are, and how they are timed.
///
/// A cell is one scene at one size, strain and velocity correction. Within a cell the same motion
/// is computed by several variants of the method, and the first of them, the original, is what the
/// others are compared with. They are also compared with the previewed original, the method to
/// which the paper compares: it computes the previewed positions of both particles anew at every
/// visit, where the original here keeps them.
///
/// `seconds` is the time of the solver's stages, without `report`: measuring the strain is no part
/// of the method and costs the same for every variant. Short runs are repeated and the fastest
/// counts; the variants of a cell take turns, so that a machine that slows down slows all alike.
#pragma once

#include <weft/weft.h>

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tools/program/run/runner.h"

namespace weft::tools::paper {

/// method: the sections in use, "original", "4.3", "4.2" or "4.2+4.3"; section 4.4 is `frozen`.
struct Variant {
  std::string_view method;
  bool anticipate = false;  ///< section 4.2
  bool skip = false;        ///< section 4.3
  Directions directions = Directions::each;
  bool previews = false;  ///< at every visit

  bool is_original() const {
    return !anticipate && !skip && directions == Directions::each && !previews;
  }
  /// As in the paper's Table 1: "4.2+4.3+4.4", or "4.4" for nothing but frozen directions.
  std::string label() const;
};

struct Cell {
  std::string_view scene;
  int size = 20;
  double strain = 0;  ///< the tolerance, a fraction
  bool velocity_correction = false;
  int steps = 200;
  std::span<const Variant> variants;  ///< the original first, the previewed one not among them
};

struct Row {
  Cell cell;
  Variant variant;
  double seconds = 0;                      ///< fastest run, all steps together
  double times_faster = 1;                 ///< than the original
  double times_faster_than_previewed = 1;  ///< than the previewed original
  int runs = 0;
  RunSummary summary{};
};

/// What is known of a cell: a row per variant, and the previewed original.
struct Measurement {
  std::vector<Row> rows;
  Row previewed;
};

struct Study {
  bool quick = false;
  int repeat = 5;
  double sphere_mass = 0;      ///< of sphere_drop, kg
  std::vector<Row> rows;       ///< Table 1, figures 2 and 3
  std::vector<Row> figure_4;   ///< hang, original and fully optimised, by size
  std::vector<Row> previewed;  ///< of each cell of both, in their order
};

/// All cells of Table 1 and of figure 4. quick: fewer steps, and figure 4 up to 20 x 20 only.
std::vector<Cell> table_cells(bool quick);
std::vector<Cell> figure_4_cells(bool quick);

/// done of total frames of this run; called after every frame.
using Progress = std::function<void(const Cell&, const Variant&, int done, int total)>;

/// repeat: most runs of one variant; fewer if they take long.
Result<Measurement> measure(const Cell& cell, int repeat, const Progress& progress);

}  // namespace weft::tools::paper
