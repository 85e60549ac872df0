#pragma once

#include <string>

#include "sandglass/simulation.hpp"
#include "support/scenes.hpp"

/// A block of soft tissue on its foot, for simulations.
namespace sandglass::verification::simulated_block {

/// A case without a mesh; `driven` is the table of the imposed motion.
inline std::string text_of(const std::string& driven, const std::string& answer = "dynamic") {
  const std::string dynamics = "[dynamics]\nduration = 0.2\ndamping = 3.0\nframes = 1\n";
  return "[case]\nname = \"block\"\nrequirement = \"A block is moved.\"\nanswer = \"" + answer +
         "\"\n"
         "[material]\nlaw = \"neo-hookean\"\nyoung_modulus = 3000.0\npoisson_ratio = 0.45\ndensity = 1000.0\n"
         "[sets]\nfoot = { z = [0.0, 0.0] }\n[[displacement]]\nset = \"foot\"\nvalue = [0.0, 0.0, 0.0]\n" +
         driven + (answer == "dynamic" ? dynamics : "");
}

/// The head is pulled.
inline const std::string pulled = "[[displacement]]\nset = \"head\"\nvalue = [0.02, 0.01, 0.03]\n";

/// A block with its head as a set.
inline MeshArrays block() {
  const Mesh mesh = box({0.1, 0.1, 0.2}, {2, 2, 4});
  return {mesh.points,
          mesh.cells,
          {{"head", nodes_where(mesh.points, [](const Vector& X) { return X[2] > 0.19; })}}};
}

/// A ball above the head of the block; more keys may follow.
inline std::string ball(const std::string& method) {
  return "[[obstacle]]\nname = \"ball\"\nset = \"head\"\nshape = \"sphere\"\nradius = 0.05\n"
         "point = [0.05, 0.04, 0.25]\nmethod = \"" +
         method + "\"\n";
}

}  // namespace sandglass::verification::simulated_block
