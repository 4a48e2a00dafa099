/// Terrain: the distance from a surface of triangles over a grid, and from the sides below it.
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "engine/bodies/build_shape.h"
#include "engine/validation.h"
#include "kernels/reference/distances.h"

namespace weft {
namespace {

using kernels::Vector;
using reference::Gap;

class HeightFieldForm final : public reference::Form {
 public:
  explicit HeightFieldForm(const HeightField& field);
  Gap gap(Vector y) const override;
  /// The nearest place is not looked for where y is far over the ground.
  reference::Touch touch(double thickness, Vector y0, Vector y1) const override {
    return is_over(y1, thickness + length(y1 - y0)) ? reference::Touch{}
                                                    : Form::touch(thickness, y0, y1);
  }
  double clear(double thickness, Vector y0, Vector y1) const override {
    const double clear = std::min(spacing_x_, spacing_z_);
    return is_over(y1, thickness + length(y1 - y0) + 3 * clear) ? clear
                                                                : Form::clear(thickness, y0, y1);
  }
  /// m, of the rectangle along x and z.
  double width() const { return width_; }
  double depth() const { return depth_; }

 private:
  /// The part of the surface over one cell, or over 2^level times 2^level of them.
  struct Range {
    double low = 0, high = 0;  // m
  };
  struct Level {
    std::size_t columns = 0, rows = 0;
    std::vector<Range> cells{};
  };
  /// A point of the surface, on a triangle with this normal.
  struct Place {
    Vector at{}, normal{};
    bool is_within = false;  // of its triangle; else it may be on a side or a corner
    double square = 0;       // m^2, of the distance that is looked for
  };
  struct Cell {
    std::size_t column = 0, row = 0;
  };

  Vector point(std::size_t column, std::size_t row) const {
    return {static_cast<double>(column) * spacing_x_, heights_[row * columns_ + column],
            static_cast<double>(row) * spacing_z_};
  }
  /// Cells that a square around a place meets, of the finest level at which they are four at most.
  struct Block {
    std::size_t level = 0;
    Cell first{}, last{};
  };
  Block block_around(Vector y, double reach) const;
  /// Whether it is higher than all of the ground within the reach, by as much.
  bool is_over(Vector y, double reach) const;
  Cell cell_at(double x, double z) const;
  Place over(double x, double z) const;
  void see(Vector y, std::size_t level, Cell cell, Place& nearest) const;
  void see_triangles(Vector y, Cell cell, Place& nearest) const;
  Place nearest_to(Vector y, Place nearest) const;

  std::size_t columns_, rows_;
  double spacing_x_, spacing_z_, width_, depth_;  // m
  std::vector<double> heights_;
  std::vector<Level> levels_;  // of cells, then of four of them each, ...
};

/// The number of the interval that a place is in, of `count` of them.
std::size_t interval_at(double place, double spacing, std::size_t count) {
  const double at = place / spacing;
  if (!(at > 0)) return 0;
  return at < static_cast<double>(count) ? static_cast<std::size_t>(at) : count - 1;
}

double beyond(double at, double low, double high) { return std::max({low - at, at - high, 0.0}); }

Vector upward_normal(Vector a, Vector b, Vector c) {
  const Vector across = cross(b - a, c - a);
  const Vector normal = kernels::direction(across, length(across));
  return normal.y < 0 ? -1.0 * normal : normal;
}

HeightFieldForm::HeightFieldForm(const HeightField& field)
    : Form(std::min(field.spacing_x, field.spacing_z)),
      columns_(field.columns),
      rows_(field.rows),
      spacing_x_(field.spacing_x),
      spacing_z_(field.spacing_z),
      width_(static_cast<double>(columns_ - 1) * spacing_x_),
      depth_(static_cast<double>(rows_ - 1) * spacing_z_),
      heights_(field.heights) {
  Level cells{.columns = columns_ - 1, .rows = rows_ - 1};
  for (std::size_t row = 0; row < cells.rows; ++row) {
    for (std::size_t column = 0; column < cells.columns; ++column) {
      const double* const h = &heights_[row * columns_ + column];
      const auto [low, high] = std::minmax({h[0], h[1], h[columns_], h[columns_ + 1]});
      cells.cells.push_back({low, high});
    }
  }
  levels_.push_back(std::move(cells));
  while (levels_.back().columns > 1 || levels_.back().rows > 1) {
    const Level& fine = levels_.back();
    Level coarse{.columns = (fine.columns + 1) / 2, .rows = (fine.rows + 1) / 2};
    constexpr double kFar = std::numeric_limits<double>::infinity();
    coarse.cells.assign(coarse.columns * coarse.rows, {kFar, -kFar});
    for (std::size_t row = 0; row < fine.rows; ++row) {
      for (std::size_t column = 0; column < fine.columns; ++column) {
        const Range& part = fine.cells[row * fine.columns + column];
        Range& whole = coarse.cells[row / 2 * coarse.columns + column / 2];
        whole = {std::min(whole.low, part.low), std::max(whole.high, part.high)};
      }
    }
    levels_.push_back(std::move(coarse));
  }
}

HeightFieldForm::Cell HeightFieldForm::cell_at(double x, double z) const {
  return {interval_at(x, spacing_x_, columns_ - 1), interval_at(z, spacing_z_, rows_ - 1)};
}

/// The surface over a point of the rectangle.
HeightFieldForm::Place HeightFieldForm::over(double x, double z) const {
  const auto [column, row] = cell_at(x, z);
  const Vector from = point(column, row), to = point(column + 1, row + 1);
  const double along_x = (x - from.x) / spacing_x_, along_z = (z - from.z) / spacing_z_;
  const bool is_first = along_x >= along_z;
  const Vector third = is_first ? point(column + 1, row) : point(column, row + 1);
  const double first = is_first ? along_x : along_z, second = is_first ? along_z : along_x;
  const double height = from.y + first * (third.y - from.y) + second * (to.y - third.y);
  return {.at = {x, height, z}, .normal = upward_normal(from, third, to), .is_within = true};
}

void HeightFieldForm::see_triangles(Vector y, Cell cell, Place& nearest) const {
  const Vector from = point(cell.column, cell.row), to = point(cell.column + 1, cell.row + 1);
  for (const Vector third : {point(cell.column + 1, cell.row), point(cell.column, cell.row + 1)}) {
    const reference::Nearest found = reference::nearest_in_triangle(y, from, third, to);
    const double square = dot(found.r, found.r);
    if (!(square < nearest.square)) continue;
    const bool is_within = reference::corners_of(found) == 0b111;
    nearest = {y - found.r, upward_normal(from, third, to), is_within, square};
  }
}

void HeightFieldForm::see(Vector y, std::size_t level, Cell cell, Place& nearest) const {
  const Level& here = levels_[level];
  const Range& range = here.cells[cell.row * here.columns + cell.column];
  const double side = std::ldexp(1.0, static_cast<int>(level));
  const double x0 = static_cast<double>(cell.column) * side * spacing_x_,
               z0 = static_cast<double>(cell.row) * side * spacing_z_;
  const double x = beyond(y.x, x0, x0 + side * spacing_x_), h = beyond(y.y, range.low, range.high),
               z = beyond(y.z, z0, z0 + side * spacing_z_);
  if (!(x * x + h * h + z * z < nearest.square)) return;
  if (level == 0) return see_triangles(y, cell, nearest);
  const Level& fine = levels_[level - 1];
  for (std::size_t row = 2 * cell.row; row < std::min(2 * cell.row + 2, fine.rows); ++row) {
    for (std::size_t column = 2 * cell.column; column < std::min(2 * cell.column + 2, fine.columns);
         ++column)
      see(y, level - 1, {column, row}, nearest);
  }
}

HeightFieldForm::Block HeightFieldForm::block_around(Vector y, double reach) const {
  Block block{.first = cell_at(y.x - reach, y.z - reach),
              .last = cell_at(y.x + reach, y.z + reach)};
  auto& [level, first, last] = block;
  while (last.column - first.column > 1 || last.row - first.row > 1) {
    ++level;
    for (std::size_t* number : {&first.column, &first.row, &last.column, &last.row}) *number /= 2;
  }
  return block;
}

bool HeightFieldForm::is_over(Vector y, double reach) const {
  const auto [level, first, last] = block_around(y, reach);
  const Level& here = levels_[level];
  for (std::size_t row = first.row; row <= last.row; ++row) {
    for (std::size_t column = first.column; column <= last.column; ++column) {
      if (!(y.y - here.cells[row * here.columns + column].high > reach)) return false;
    }
  }
  return true;
}

/// Looks in the cells that are no farther away than a place that is known.
HeightFieldForm::Place HeightFieldForm::nearest_to(Vector y, Place nearest) const {
  const auto [level, first, last] = block_around(y, std::sqrt(nearest.square));
  for (std::size_t row = first.row; row <= last.row; ++row) {
    for (std::size_t column = first.column; column <= last.column; ++column)
      see(y, level, {column, row}, nearest);
  }
  return nearest;
}

/// Beside the rectangle and under its border the sides are nearest. Else it is the surface, or,
/// from inside, one of both.
Gap HeightFieldForm::gap(Vector y) const {
  const double x = std::clamp(y.x, 0.0, width_), z = std::clamp(y.z, 0.0, depth_);
  const Vector aside{y.x - x, 0, y.z - z};
  const bool is_beside = aside.x != 0 || aside.z != 0;
  Place place = over(x, z);
  const bool is_under = y.y < place.at.y;
  if (is_beside && is_under) {
    const double l = length(aside);
    return {l, kernels::direction(aside, l)};
  }
  const Vector from_place = y - place.at;
  constexpr double kSlack = 1 + 1e-9;  // so that the triangle there is looked at
  place.square = kSlack * dot(from_place, from_place);
  place = nearest_to(y, place);
  const Vector d = y - place.at;
  const double l = length(d), touching = 1e-9 * std::min(spacing_x_, spacing_z_);
  Gap gap{is_under ? -l : l, place.normal};
  if (place.is_within)
    gap.gap = dot(place.normal, d);
  else if (l > touching)
    gap.normal = (1 / gap.gap) * d;
  if (!is_under) return gap;
  const std::pair<double, Vector> sides[] = {
      {y.x, {-1, 0, 0}}, {width_ - y.x, {1, 0, 0}}, {y.z, {0, 0, -1}}, {depth_ - y.z, {0, 0, 1}}};
  for (const auto& [depth, normal] : sides) {
    if (-depth > gap.gap) gap = {-depth, normal};
  }
  return gap;
}

}  // namespace

BuiltShape build(const HeightField& field) {
  for (const auto& [name, count] :
       {std::pair{"columns", field.columns}, std::pair{"rows", field.rows}}) {
    if (count < 2) return refuse(FieldName(name), "must be 2 or more", std::to_string(count));
  }
  const std::uint64_t count = std::uint64_t{field.columns} * field.rows;
  if (field.heights.size() != count) {
    return refuse("heights", "must be columns times rows, " + std::to_string(count),
                  std::to_string(field.heights.size()));
  }
  double highest = 0;
  for (const double height : field.heights) highest = std::max(highest, std::abs(height));
  auto form = std::make_unique<HeightFieldForm>(field);
  const double width = form->width(), depth = form->depth();
  ShapeParts parts;
  parts.form = std::move(form);
  parts.bounds.corners = {{0, 0, 0}, {width, 0, 0}, {0, 0, depth}, {width, 0, depth}};
  parts.bounds.radius = highest;
  parts.bounds.has_end = false;
  return std::make_shared<BodyShape>(std::move(parts));
}

}  // namespace weft
