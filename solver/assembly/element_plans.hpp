#pragma once

#include <algorithm>
#include <memory>
#include <tuple>
#include <utility>
#include <vector>

#include "assembly/element_block.hpp"
#include "assembly/internal_force.hpp"
#include "base/type_list.hpp"
#include "element/method_traits.hpp"
#include "mesh/node_elements.hpp"

namespace sandglass {

template <class Levels, class Number>
class ElementPlans;

/// The elements of a mesh, grouped by their levels: the constants of their kernels in blocks of as many
/// elements as `Number` has lanes, chunk by chunk.
template <class... Methods, class Number>
class ElementPlans<TypeList<Methods...>, Number> {
  static constexpr bool adapts = sizeof...(Methods) > 1;
  static constexpr int width = Lanes<Number>::width;

  /// A method's elements with the law of their set-up; their constants do not depend on the law.
  template <class Method>
  using KernelOf = FormulationOf<Method, CalledLaw>;

 public:
  /// What the constants of an element depend on besides its shape.
  struct Setup {
    CalledLaw law;
    HourglassSettings settings;
  };

  /// One part for each level.
  using Parts = std::tuple<ElementPart<Methods, Number>...>;

  /// Chunks are immutable: plans share those whose elements have the same levels.
  struct Plan final : ElementLevels {
    std::vector<std::size_t> levels;  // of each element; empty if there is only one
    std::vector<std::shared_ptr<const Parts>> chunks;
  };

  ElementPlans(const Mesh& mesh, const Materials& materials, const HourglassSettings& settings,
               std::shared_ptr<const Layout> layout)
      : layout_(std::move(layout)), axes_(materials.axes) {
    for (const Material& material : materials.list) {
      setups_.push_back({elastic_law(kernel_law(material)), settings});
      setups_.back().settings.density = material.density;
    }
    if constexpr (adapts) {
      regrouping_ = std::make_unique<const Regrouping>(mesh, *layout_);
      undeformed_ = plan_at(std::vector<std::size_t>(mesh.cells.size()), nullptr);
    } else {
      auto plan = std::make_shared<Plan>();
      plan->chunks.resize(layout_->chunks.size());
      for (std::size_t c = layout_->local_chunks.first; c < layout_->local_chunks.last; ++c) {
        plan->chunks[c] = only_part(mesh, layout_->chunks[c]);
      }
      undeformed_ = std::move(plan);
    }
  }

  /// Of a material.
  const Setup& setup_of(std::size_t material) const { return setups_[material]; }

  /// Of each element; empty: those of space.
  const std::vector<MaterialAxes<double>>& axes() const { return axes_; }

  /// The elements of each chunk, of methods that adapt.
  const std::vector<std::vector<int>>& elements_of_chunks() const { return regrouping_->elements; }

  /// All elements at their lowest level.
  const std::shared_ptr<const Plan>& undeformed() const { return undeformed_; }

  /// The elements at these levels; chunks whose levels are as before are shared.
  std::shared_ptr<const Plan> at_levels(std::vector<std::size_t> levels, const Plan& before) const {
    return plan_at(std::move(levels), &before);
  }

 private:
  /// The data needed for changing the levels of elements.
  struct Regrouping {
    Regrouping(const Mesh& body, const Layout& layout) : mesh(body), neighbours(body) {
      for (const auto& chunk : layout.chunks) elements.push_back(layout.elements_of(chunk));
    }

    Mesh mesh;
    NodeElements neighbours;
    std::vector<std::vector<int>> elements;  // of each chunk
  };

  /// All elements of a chunk, in the groups of the layout.
  std::shared_ptr<const Parts> only_part(const Mesh& mesh, const Layout::Chunk& chunk) const {
    auto parts = std::make_shared<Parts>();
    auto& part = std::get<0>(*parts);
    part.groups = layout_;
    part.first = chunk.first;
    part.last = chunk.last;
    if (chunk.first < chunk.last) part.first_block = layout_->groups[chunk.first].first_pack;
    fill_blocks(part, mesh);
    return parts;
  }

  std::shared_ptr<const Plan> plan_at(std::vector<std::size_t> levels, const Plan* before) const {
    auto plan = std::make_shared<Plan>();
    plan->levels = std::move(levels);
    plan->chunks.resize(layout_->chunks.size());
    for (std::size_t c = layout_->local_chunks.first; c < layout_->local_chunks.last; ++c) {
      const auto& elements = elements_of_chunks()[c];
      const bool same = before != nullptr && std::all_of(elements.begin(), elements.end(), [&](int e) {
                          const auto n = static_cast<std::size_t>(e);
                          return before->levels[n] == plan->levels[n];
                        });
      plan->chunks[c] = same ? before->chunks[c] : parts_at(c, plan->levels);
    }
    return plan;
  }

  /// The elements of a chunk, grouped by their levels.
  std::shared_ptr<const Parts> parts_at(std::size_t c, const std::vector<std::size_t>& levels) const {
    auto parts = std::make_shared<Parts>();
    std::size_t level = 0;
    const auto fill = [&](auto& part) {
      std::vector<int> chosen;
      std::copy_if(elements_of_chunks()[c].begin(), elements_of_chunks()[c].end(), std::back_inserter(chosen),
                   [&](int e) { return levels[static_cast<std::size_t>(e)] == level; });
      part.groups = std::make_shared<ElementGroups>(
          groups_within(*layout_, layout_->chunks[c], regrouping_->mesh, regrouping_->neighbours, chosen));
      part.last = part.groups->groups.size();
      fill_blocks(part, regrouping_->mesh);
      ++level;
    };
    std::apply([&](auto&... part) { (fill(part), ...); }, *parts);
    return parts;
  }

  template <class Method>
  void fill_blocks(ElementPart<Method, Number>& part, const Mesh& mesh) const {
    for (std::size_t g = part.first; g < part.last; ++g) {
      const auto& group = part.groups->groups[g];
      const Setup& setup = setups_[group.material];
      for (std::size_t k = 0; k < group.packs; ++k) {
        const int* elements = part.groups->elements.data() + (group.first_pack + k) * width;
        const auto law_of = [&](int lane) {
          const bool own = !axes_.empty() && elements[lane] >= 0;
          return setup.law.with_axes(own ? &axes_[static_cast<std::size_t>(elements[lane])] : nullptr);
        };
        part.blocks.push_back(element_block<KernelOf<Method>, Number>(
            mesh, *part.groups, layout_->node_of_row, group.first_face + k, law_of, setup.settings));
        if (const auto axes = axes_of_block<Number>(axes_, elements)) part.axes.push_back(*axes);
      }
    }
  }

  std::shared_ptr<const Layout> layout_;  // of all elements
  std::vector<MaterialAxes<double>> axes_;
  std::vector<Setup> setups_;                     // of each material
  std::unique_ptr<const Regrouping> regrouping_;  // of methods that adapt
  std::shared_ptr<const Plan> undeformed_;
};

}  // namespace sandglass
