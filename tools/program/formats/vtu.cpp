#include "tools/program/formats/vtu.h"

#include <fmt/format.h>

#include <bit>
#include <span>

namespace weft::tools {
namespace {

static_assert(std::endian::native == std::endian::little, "the file says LittleEndian");

constexpr std::uint8_t kLine = 3, kTriangle = 5;  // VTK_LINE, VTK_TRIANGLE

/// The text of the file, and the blocks that go behind it: each the number of its bytes, then
/// these.
class VtuFile {
 public:
  void add(const std::string& text) { text_ += text; }
  template <class Number>
  void add_array(const std::string& name, const char* type, int components,
                 std::span<const Number> numbers) {
    text_ += fmt::format(
        "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" "
        "offset=\"{}\"/>\n",
        type, name, components, blocks_.size());
    const std::uint64_t size = numbers.size_bytes();
    blocks_.append(reinterpret_cast<const char*>(&size), sizeof size);
    blocks_.append(reinterpret_cast<const char*>(numbers.data()), numbers.size_bytes());
  }
  void add_arrays(const char* element, const std::vector<VtuArray>& arrays) {
    text_ += fmt::format("<{}>\n", element);
    for (const auto& [name, components, values] : arrays)
      add_array<double>(name, "Float64", components, values);
    text_ += fmt::format("</{}>\n", element);
  }
  std::string bytes() const {
    return text_ + "<AppendedData encoding=\"raw\">\n_" + blocks_ +
           "\n</AppendedData>\n</VTKFile>\n";
  }

 private:
  std::string text_, blocks_;
};

void add_points(VtuFile& file, const std::vector<Vec3>& points) {
  std::vector<double> numbers;
  for (const auto& [x, y, z] : points) numbers.insert(numbers.end(), {x, y, z});
  file.add("<Points>\n");
  file.add_array<double>("Points", "Float64", 3, numbers);
  file.add("</Points>\n");
}

void add_cells(VtuFile& file, const VtuGrid& grid) {
  std::vector<std::int64_t> corners, ends;
  std::vector<std::uint8_t> kinds;
  const auto add = [&](std::span<const std::uint32_t> cell, std::uint8_t kind) {
    corners.insert(corners.end(), cell.begin(), cell.end());
    ends.push_back(static_cast<std::int64_t>(corners.size()));
    kinds.push_back(kind);
  };
  for (const auto& triangle : grid.triangles) add(triangle, kTriangle);
  for (const auto& line : grid.lines) add(line, kLine);
  file.add("<Cells>\n");
  file.add_array<std::int64_t>("connectivity", "Int64", 1, corners);
  file.add_array<std::int64_t>("offsets", "Int64", 1, ends);
  file.add_array<std::uint8_t>("types", "UInt8", 1, kinds);
  file.add("</Cells>\n");
}

}  // namespace

std::string vtu_bytes(const VtuGrid& grid) {
  VtuFile file;
  file.add(
      fmt::format("<?xml version=\"1.0\"?>\n"
                  "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
                  "header_type=\"UInt64\">\n"
                  "<UnstructuredGrid>\n<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n",
                  grid.points.size(), grid.triangles.size() + grid.lines.size()));
  add_points(file, grid.points);
  add_cells(file, grid);
  file.add_arrays("PointData", grid.of_points);
  file.add_arrays("CellData", grid.of_cells);
  file.add("</Piece>\n</UnstructuredGrid>\n");
  return file.bytes();
}

std::string pvd_text(const std::vector<std::pair<double, std::string>>& files) {
  const auto escaped = [](const std::string& name) {
    std::string text;
    for (const char letter : name) {
      text += letter == '&'   ? "&amp;"
              : letter == '<' ? "&lt;"
              : letter == '"' ? "&quot;"
                              : std::string(1, letter);
    }
    return text;
  };
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" "
      "byte_order=\"LittleEndian\">\n<Collection>\n";
  for (const auto& [time, name] : files)
    text += fmt::format("<DataSet timestep=\"{}\" part=\"0\" file=\"{}\"/>\n", time, escaped(name));
  return text + "</Collection>\n</VTKFile>\n";
}

}  // namespace weft::tools
