#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <span>
#include <vector>

#include "math/lanes.hpp"
#include "model/internal_force.hpp"

namespace sandglass {

/// All elements of one formulation, their constants computed once, in blocks of as many elements as `Number`
/// computes at a time: a pack for speed, a plain double for comparison. Elements are added in a fixed order,
/// so that the same input gives the same bits.
template <class Formulation, class Law, class Number>
class ElementAssembly final : public InternalForce {
  static constexpr int width = Lanes<Number>::width;
  using Element = typename Formulation::template Element<double>;
  using ElementBlock = typename Formulation::template Element<Number>;

 public:
  ElementAssembly(const Mesh& mesh, const Law& law, const HourglassSettings& settings)
      : cells_(mesh.cells), law_(law) {
    for (std::size_t first = 0; first < cells_.size(); first += width) {
      ConstantsBlock block;
      for (int lane = 0; lane < width; ++lane) {
        // The last block is filled up with its last element; what the surplus lanes compute is never added.
        const std::size_t e = std::min(first + static_cast<std::size_t>(lane), cells_.size() - 1);
        const Element element = Formulation::precompute(gather(mesh.points, cells_[e]), law_, settings);
        const auto constants = std::bit_cast<Constants>(element);
        for (std::size_t n = 0; n < numbers; ++n) Lanes<Number>::set(block[n], lane, constants[n]);
      }
      blocks_.push_back(std::bit_cast<ElementBlock>(block));
    }
  }

  // Without `flatten` the compiler leaves small matrix functions out of line, which costs a third of the
  // time.
  [[gnu::flatten]] void evaluate(const NodalField& u, NodalField& force) const override {
    const Law law = law_;  // a copy that no store can alias: its moduli are computed once
    std::fill(force.begin(), force.end(), Vector{});
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      const std::span<const Hexahedron> cells = cells_of(b);
      scatter(Formulation::force(gather_block(u, cells), blocks_[b], law), cells, force);
    }
  }

  StrainEnergies energies(const NodalField& u) const override {
    StrainEnergies sum;
    for (std::size_t e = 0; e < cells_.size(); ++e) {
      const auto energy = Formulation::energy(gather(u, cells_[e]), element(e), law_);
      sum.strain += energy.strain;
      sum.hourglass += energy.hourglass;
    }
    return sum;
  }

  void hourglass_energy_densities(const NodalField& u, std::span<double> densities) const override {
    for (std::size_t e = 0; e < cells_.size(); ++e) {
      const Element constants = element(e);
      densities[e] = Formulation::energy(gather(u, cells_[e]), constants, law_).hourglass / constants.body.V;
    }
  }

  void jacobians(const NodalField& u, std::span<double> jacobians) const override {
    for (std::size_t e = 0; e < cells_.size(); ++e) {
      jacobians[e] = Formulation::mean_jacobian(gather(u, cells_[e]), element(e));
    }
  }

  void smallest_jacobians(const NodalField& u, std::span<double> jacobians) const override {
    for (std::size_t e = 0; e < cells_.size(); ++e) {
      jacobians[e] = Formulation::smallest_jacobian(gather(u, cells_[e]), element(e));
    }
  }

  void stiffness_bounds(const NodalField& u, std::span<double> bounds) const override {
    for (std::size_t e = 0; e < cells_.size(); ++e) {
      bounds[e] = Formulation::stiffness_bound(gather(u, cells_[e]), element(e), law_);
    }
  }

 private:
  static constexpr std::size_t numbers = sizeof(Element) / sizeof(double);
  static_assert(sizeof(ElementBlock) == numbers * sizeof(Number),
                "an element's constants must all be of its number type");

  using Constants = std::array<double, numbers>;
  using ConstantsBlock = std::array<Number, numbers>;

  /// The constants of one element, out of its block.
  Element element(std::size_t e) const {
    const auto block = std::bit_cast<ConstantsBlock>(blocks_[e / width]);
    Constants constants;
    for (std::size_t n = 0; n < numbers; ++n) {
      constants[n] = Lanes<Number>::get(block[n], static_cast<int>(e % width));
    }
    return std::bit_cast<Element>(constants);
  }

  /// The elements of a block; fewer than `width` in the last one.
  std::span<const Hexahedron> cells_of(std::size_t b) const {
    const std::size_t first = b * width;
    return {cells_.data() + first, std::min<std::size_t>(width, cells_.size() - first)};
  }

  static NodalVectors<Number> gather_block(const NodalField& field, std::span<const Hexahedron> cells) {
    NodalVectors<Number> rows;
    for (int lane = 0; lane < width; ++lane) {
      const Hexahedron& cell = cells[std::min(static_cast<std::size_t>(lane), cells.size() - 1)];
      for (int I = 0; I < 8; ++I) {
        const Vector& row = field[static_cast<std::size_t>(cell[static_cast<std::size_t>(I)])];
        for (int i = 0; i < 3; ++i) Lanes<Number>::set(rows(I, i), lane, row[static_cast<std::size_t>(i)]);
      }
    }
    return rows;
  }

  static void scatter(const NodalVectors<Number>& rows, std::span<const Hexahedron> cells,
                      NodalField& field) {
    for (std::size_t lane = 0; lane < cells.size(); ++lane) {
      for (int I = 0; I < 8; ++I) {
        Vector& row = field[static_cast<std::size_t>(cells[lane][static_cast<std::size_t>(I)])];
        for (int i = 0; i < 3; ++i) {
          row[static_cast<std::size_t>(i)] += Lanes<Number>::get(rows(I, i), static_cast<int>(lane));
        }
      }
    }
  }

  std::vector<Hexahedron> cells_;
  std::vector<ElementBlock> blocks_;
  Law law_;
};

}  // namespace sandglass
