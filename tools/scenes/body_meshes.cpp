#include "tools/scenes/body_meshes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace weft::scenes {
namespace {

Vec3 sum(Vec3 a, double s, Vec3 b) { return {a.x + s * b.x, a.y + s * b.y, a.z + s * b.z}; }

Vec3 cross(Vec3 a, Vec3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

Vec3 unit(Vec3 v) {
  const double l = std::hypot(v.x, v.y, v.z);
  return {v.x / l, v.y / l, v.z / l};
}

/// Rings of the same number of vertices, between two poles.
class RingMesh {
 public:
  RingMesh(Vec3 pole, int around) : around_(around) { mesh_.vertices.push_back(pole); }

  void add_ring(Vec3 centre, double radius, Vec3 u, Vec3 v) {
    const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
    for (int i = 0; i < around_; ++i) {
      const double angle = 2 * std::numbers::pi * i / around_;
      const Vec3 across = sum(sum({}, std::cos(angle), u), std::sin(angle), v);
      mesh_.vertices.push_back(sum(centre, radius, across));
    }
    const auto n = static_cast<std::uint32_t>(around_);
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t a = first + i, b = first + (i + 1) % n;
      if (first == 1) {
        mesh_.triangles.push_back({0, b, a});
      } else {
        mesh_.triangles.insert(mesh_.triangles.end(), {{a - n, b - n, b}, {a - n, b, a}});
      }
    }
  }
  TriangleMesh closed(Vec3 pole) {
    const auto last = static_cast<std::uint32_t>(mesh_.vertices.size());
    const auto n = static_cast<std::uint32_t>(around_), first = last - n;
    mesh_.vertices.push_back(pole);
    for (std::uint32_t i = 0; i < n; ++i)
      mesh_.triangles.push_back({last, first + i, first + (i + 1) % n});
    return std::move(mesh_);
  }

 private:
  int around_;
  TriangleMesh mesh_;
};

}  // namespace

TriangleMesh capsule_mesh(const Capsule& c, int around) {
  const Vec3 way = sum(c.b, -1, c.a);
  const double length = std::hypot(way.x, way.y, way.z);
  const Vec3 w = length > 0 ? unit(way) : Vec3{0, 1, 0};
  const Vec3 u = unit(cross(w, std::abs(w.x) < 0.5 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}));
  const Vec3 v = cross(w, u);
  const int rows = std::max(around / 4, 1);
  // The side touches both balls where its normal leans by this much from the axis' right angle.
  const double lean = length > 0 ? std::asin((c.radius_a - c.radius_b) / length) : 0;
  const double half = std::numbers::pi / 2;
  RingMesh rings(sum(c.a, -c.radius_a, w), around);
  const auto add = [&](Vec3 centre, double radius, double angle) {  // from the axis' right angle
    rings.add_ring(sum(centre, radius * std::sin(angle), w), radius * std::cos(angle), u, v);
  };
  for (int row = 1; row <= rows; ++row) add(c.a, c.radius_a, -half + (half + lean) * row / rows);
  if (length > 0) {
    const double side = std::max(c.radius_a, c.radius_b) * 2 * std::numbers::pi / around;
    const int bands = std::max(1, static_cast<int>(std::lround(length / side)));
    for (int band = 1; band <= bands; ++band) {
      const double share = static_cast<double>(band) / bands;
      add(sum(c.a, share * length, w), c.radius_a + share * (c.radius_b - c.radius_a), lean);
    }
  }
  for (int row = 1; row < rows; ++row) add(c.b, c.radius_b, lean + (half - lean) * row / rows);
  return rings.closed(sum(c.b, c.radius_b, w));
}

TriangleMesh ball_mesh(const weft::Ball& ball, int around) {
  return capsule_mesh({ball.centre, ball.centre, ball.radius, ball.radius}, around);
}

TriangleMesh ring_mesh(double radius, double tube_radius, int along, int around) {
  TriangleMesh mesh;
  for (int i = 0; i < along; ++i) {
    const double turn = 2 * std::numbers::pi * i / along;
    for (int j = 0; j < around; ++j) {
      const double angle = 2 * std::numbers::pi * j / around;
      const double out = radius + tube_radius * std::cos(angle);
      mesh.vertices.push_back(
          {out * std::cos(turn), tube_radius * std::sin(angle), out * std::sin(turn)});
    }
  }
  const auto number = [&](int i, int j) {
    return static_cast<std::uint32_t>((i % along) * around + j % around);
  };
  for (int i = 0; i < along; ++i) {
    for (int j = 0; j < around; ++j) {
      const std::uint32_t a = number(i, j), b = number(i + 1, j), c = number(i + 1, j + 1),
                          d = number(i, j + 1);
      mesh.triangles.insert(mesh.triangles.end(), {{a, c, b}, {a, d, c}});
    }
  }
  return mesh;
}

TriangleMesh torus_mesh(const Torus& torus, int along, int around) {
  TriangleMesh mesh = ring_mesh(torus.major, torus.minor, along, around);
  const Vec3 w = unit(torus.axis);
  const Vec3 u = unit(cross(w, std::abs(w.x) < 0.5 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}));
  const Vec3 v = cross(u, w);
  for (Vec3& p : mesh.vertices) p = sum(sum(sum(torus.centre, p.x, u), p.y, w), p.z, v);
  return mesh;
}

TriangleMesh terrain_mesh(const HeightField& field) {
  TriangleMesh mesh;
  for (std::uint32_t row = 0; row < field.rows; ++row) {
    for (std::uint32_t column = 0; column < field.columns; ++column) {
      mesh.vertices.push_back({column * field.spacing_x,
                               field.heights[std::size_t{row} * field.columns + column],
                               row * field.spacing_z});
    }
  }
  for (std::uint32_t row = 0; row + 1 < field.rows; ++row) {
    for (std::uint32_t column = 0; column + 1 < field.columns; ++column) {
      const std::uint32_t a = row * field.columns + column, b = a + 1, c = a + field.columns,
                          d = c + 1;
      mesh.triangles.insert(mesh.triangles.end(), {{a, d, b}, {a, c, d}});
    }
  }
  return mesh;
}

TriangleMesh plate_mesh(double length, double width, int along, int across) {
  TriangleMesh mesh;
  for (int i = 0; i <= along; ++i) {
    for (int j = 0; j <= across; ++j)
      mesh.vertices.push_back({length * i / along - length / 2, 0, width * j / across - width / 2});
  }
  const auto n = static_cast<std::uint32_t>(across) + 1;
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(along); ++i) {
    for (std::uint32_t j = 0; j + 1 < n; ++j) {
      const std::uint32_t a = i * n + j;
      mesh.triangles.insert(mesh.triangles.end(), {{a, a + 1, a + n + 1}, {a, a + n + 1, a + n}});
    }
  }
  return mesh;
}

TriangleMesh box_mesh(Vec3 size, int along) {
  TriangleMesh mesh;
  std::map<std::array<long, 3>, std::uint32_t> number_of;
  const auto number = [&](Vec3 p) {
    const auto halves = [&](double x) { return std::lround(2 * along * x); };
    const auto [entry, is_new] = number_of.try_emplace(
        {halves(p.x), halves(p.y), halves(p.z)}, static_cast<std::uint32_t>(mesh.vertices.size()));
    if (is_new) mesh.vertices.push_back({p.x * size.x, p.y * size.y, p.z * size.z});
    return entry->second;
  };
  const TriangleMesh side = plate_mesh(1, 1, along, along);  // looks up; each face turns it
  Vec3 (*const faces[])(Vec3) = {
      [](Vec3 p) { return Vec3{p.x, 0.5, p.z}; }, [](Vec3 p) { return Vec3{p.x, -0.5, -p.z}; },
      [](Vec3 p) { return Vec3{0.5, p.z, p.x}; }, [](Vec3 p) { return Vec3{-0.5, p.z, -p.x}; },
      [](Vec3 p) { return Vec3{p.z, p.x, 0.5}; }, [](Vec3 p) { return Vec3{-p.z, p.x, -0.5}; }};
  for (const auto place : faces) {
    for (const auto& [a, b, c] : side.triangles) {
      mesh.triangles.push_back({number(place(side.vertices[a])), number(place(side.vertices[b])),
                                number(place(side.vertices[c]))});
    }
  }
  return mesh;
}

void add_mesh(const TriangleMesh& mesh, TriangleMesh& sum) {
  const auto first = static_cast<std::uint32_t>(sum.vertices.size());
  sum.vertices.insert(sum.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
  for (const auto& [a, b, c] : mesh.triangles)
    sum.triangles.push_back({first + a, first + b, first + c});
}

}  // namespace weft::scenes
