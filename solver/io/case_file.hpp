#pragma once

#include <array>
#include <filesystem>
#include <string>

#include "io/mesh_file.hpp"
#include "problem/make_scene.hpp"

namespace sandglass {

/// The tables of a case file that say how answers are compared; they are read by programs that compare.
inline constexpr std::array tables_not_read{"comparison", "expect", "profile", "published"};

/// Reads a case file, strictly: unknown keys, missing keys, wrong types and values out of range are
/// InputErrors that name file, line, key, value and rule. `law`, `generator` and method names come from their
/// lists.
/// All cases of the file: one, or every combination of its variants, named after file and variants.
std::vector<Case> read_cases(const std::filesystem::path& path);

/// The same of a file that must not have variants.
Case read_case_file(const std::filesystem::path& path);

/// A case with its mesh, generated or read.
CaseOnMesh with_mesh(Case description);

/// A case that is a text, the text of a file without [mesh] and variants, with a mesh of its own.
CaseOnMesh with_mesh(const std::string& text, MeshWithSets mesh);

/// The scenes of these, and of a case file without variants.
Scene read_scene(Case description);
Scene read_scene(const std::string& text, MeshWithSets mesh);
Scene read_scene(const std::filesystem::path& path);

/// What a case says of its method, or tl-perturbation where it says nothing. Of another method, where one is
/// named, it says no more than the precision.
MethodChoice method_of(const CaseSettings& settings, const std::optional<std::string>& named = {});

}  // namespace sandglass
