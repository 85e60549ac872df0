#pragma once

#include <array>
#include <filesystem>
#include <string>

#include "io/mesh_file.hpp"
#include "problem/make_scene.hpp"

namespace sandglass {

/// The tables of a case file about the comparison of answers, which only comparing programs read.
inline constexpr std::array tables_not_read{"comparison", "expect", "measured", "profile", "published"};

/// Reads a case file, strictly: unknown keys, missing keys, wrong types and values out of range are
/// InputErrors that name file, line, key, value and rule. `law`, `generator` and method names come from their
/// lists.
/// All cases of the file: one, or every combination of its variants, named after file and variants.
std::vector<Case> read_cases(const std::filesystem::path& path);

/// The same for a file without variants.
Case read_case_file(const std::filesystem::path& path);

/// A case with its mesh, generated or read.
CaseOnMesh with_mesh(Case description);

/// A case from text, as of a file without [mesh] and variants, and a mesh.
CaseOnMesh with_mesh(const std::string& text, MeshWithSets mesh);

/// The scenes of such cases, and of a case file without variants.
Scene read_scene(Case description);
Scene read_scene(const std::string& text, MeshWithSets mesh);
Scene read_scene(const std::filesystem::path& path);

/// The method of a case, tl-perturbation by default. If another method is named, only the precision is taken
/// from the case.
MethodChoice method_of(const CaseSettings& settings, const std::optional<std::string>& named = {});

}  // namespace sandglass
