/// Bodies that are triangle meshes, from Wavefront OBJ files.
#pragma once

#include <weft/weft.h>

#include <optional>
#include <string>
#include <vector>

#include "tools/scenes/scene_body.h"

namespace weft::tools {

/// The faces of the file as triangles; coordinates are multiplied by `scale`. An error names the
/// file.
Result<TriangleMesh> read_body_mesh(const std::string& path, double scale);

struct BodyFiles {
  std::string names = {};            ///< a file or, with one *, all files of a folder that fit
  std::optional<double> frame = {};  ///< s, from one file to the next; needed with a *
  double scale = 1;
  bool turn = false;  ///< a mesh that is inside out

  bool is_series() const { return names.find('*') != std::string::npos; }
};

/// A body whose surface is in files: rigid or, with a *, deforming. Frames are in the order of
/// their names, shorter ones first, so that numbers need no zeros before them. It is one-sided
/// where its triangles are consistently oriented; else it is two-sided, and `notes` say so.
/// A mesh that is inside out says so, too, and is turned if that was asked for.
Result<SceneBody> body_of_files(const BodyFiles& files, std::vector<std::string>& notes);

/// What a mesh that is inside out says.
std::string note_of_inside_out(const std::string& name, bool is_turned);

}  // namespace weft::tools
