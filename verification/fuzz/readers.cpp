#include "fuzz/readers.hpp"

#include <algorithm>
#include <fstream>

#include "base/error.hpp"
#include "comparison/comparison.hpp"
#include "comparison/reference_file.hpp"
#include "fuzz/odd_file.hpp"
#include "io/case_file.hpp"
#include "io/checkpoint_file.hpp"
#include "io/file_hash.hpp"
#include "io/mesh_file.hpp"
#include "support/scenes.hpp"

namespace sandglass::verification {

namespace {

void write_bytes(std::span<const std::byte> bytes, const std::filesystem::path& path) {
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

/// Limits the parameters that count elements, so that a mesh stays small.
template <class Generator>
void make_small(Generator& generator) {
  const auto cut = [](auto& value) {
    if constexpr (std::is_integral_v<std::remove_reference_t<decltype(value)>>) value = std::min(value, 4);
  };
  std::apply(
      [&](const auto&... parameter) {
        const auto cut_all = [&](auto& member) {
          if constexpr (requires { member.begin(); }) {
            for (auto& entry : member) cut(entry);
          } else {
            cut(member);
          }
        };
        (cut_all(generator.*(parameter.member)), ...);
      },
      Generator::parameters());
}

/// One cube of 10 cm on its foot. Its hashes are words, so that the corpus survives changes of hashes.
Scene cube() {
  Case description = plain_case(sample_law<NeoHookean>(0.49));
  description.displacements = {{"foot", {}}};
  Scene scene = make_scene(description, box({0.1, 0.1, 0.1}, {1, 1, 1}), {{"foot", {0, 1, 2, 3}}});
  scene.case_hash = "case";
  scene.mesh_hash = "mesh";
  return scene;
}

void read_mesh_with_scene(const std::filesystem::path& path) {
  MeshWithSets read = read_mesh_file(path);
  make_scene(plain_case(sample_law<NeoHookean>(0.49)), std::move(read.mesh), std::move(read.sets));
}

/// Seals a file that is long enough for a seal, and reads it as a checkpoint.
void read_sealed(const Scene& scene, const std::filesystem::path& path) {
  if (std::filesystem::file_size(path) > seal_size) write_seal(path);
  read_checkpoint_file(path, {{"case_hash", scene.case_hash}}, scene.mesh.points.size(),
                       scene.mesh.cells.size());
}

}  // namespace

void read_as_case_file(std::span<const std::byte> bytes, const std::filesystem::path& scratch) {
  write_bytes(bytes, scratch);
  for (auto& scene : read_cases(scratch)) {
    read_comparison(scene);
    if (auto* generator = std::get_if<AnyGenerator>(&scene.mesh)) {
      std::visit([](auto& g) { make_small(g); }, *generator);
      read_scene(std::move(scene));
    }
  }
}

void read_as_mesh_file(std::span<const std::byte> bytes, const std::filesystem::path& scratch) {
  write_bytes(bytes, scratch);
  read_mesh_with_scene(scratch);
}

void read_as_reference_file(std::span<const std::byte> bytes, const std::filesystem::path& scratch) {
  static const Scene scene = cube();
  write_bytes(bytes, scratch);
  read_reference(scratch, scene);
}

void read_as_checkpoint_file(std::span<const std::byte> bytes, const std::filesystem::path& scratch) {
  static const Scene scene = cube();
  write_bytes(bytes, scratch);
  read_sealed(scene, scratch);
}

void read_as_hdf5_content(std::span<const std::byte> bytes, const std::filesystem::path& scratch) {
  static const Scene scene = cube();
  write_odd_file(scene, bytes, scratch);
  const auto refused = [](const auto& read) {
    try {
      read();
    } catch (const InputError&) {
    }
  };
  refused([&] { read_mesh_with_scene(scratch); });
  refused([&] { read_reference(scratch, scene); });
  refused([&] { read_sealed(scene, scratch); });
}

}  // namespace sandglass::verification
