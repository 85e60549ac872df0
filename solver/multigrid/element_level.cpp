#include "multigrid/element_level.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "assembly/chunk_sum.hpp"
#include "assembly/strip_walk.hpp"
#include "base/hot_loop.hpp"
#include "element/linear_one_point.hpp"
#include "element/perturbation_stiffness.hpp"
#include "math/pack.hpp"

namespace sandglass {

namespace {

/// The pressures take so many steps in the smoother: with fewer the multigrid cycle converges slower by more
/// than they cost.
constexpr int pressure_steps = 3;

/// W floats.
template <int W>
using LanesOfFloat = std::conditional_t<W == 1, float, Pack<float, W>>;

template <int W>
class Elements final : public ElementLevel {
  using Number = LanesOfFloat<W>;

  struct Block {
    OnePoint::Element<Number> body;  ///< in the present configuration
    Number stress;                   ///< 2 mu V, V of the undeformed element
    Number hourglass;                ///< stiffness, N/m
  };

 public:
  Elements(const Mesh& mesh, const Ties& ties, const Layout& layout, const Rows<float>& free,
           const Rows<float>& springs)
      : ElementLevel(layout, pressure_steps),
        coordinates_(centred_coordinates<float>(mesh.points, layout)),
        present_(layout.rows()),
        elements_(layout.packs()) {
    resize(layout.rows(), layout.elements.size());
    free_ = free;
    springs_ = springs;
    ties_ = RowTies<float>(ties, layout);
    stiffness_.resize(layout.rows());
    tangents_.resize(layout.elements.size());
    cells_.resize(mesh.cells.size());
    for (std::size_t cell = 0; cell < layout.elements.size(); ++cell) {
      if (layout.elements[cell] >= 0) cells_[static_cast<std::size_t>(layout.elements[cell])] = cell;
    }
  }

  void update(const Rows<float>& u, const std::vector<ModelModuli>& moduli,
              const std::vector<float>& stiffening) override {
    for (std::size_t r = 0; r < present_.size(); ++r) {
      for (std::size_t i = 0; i < 3; ++i) present_[r][i] = coordinates_[r][i] + u[r][i];
    }
    std::vector<float> bounds(layout_.chunks.size());
    layout_.for_each_local_chunk(
        [&](std::size_t c) { bounds[c] = set_blocks(layout_.chunks[c], moduli, stiffening); });
    sum_over_chunks(layout_, numbers_of(stiffness_),
                    [&](std::size_t c) { add_diagonals(layout_.chunks[c]); });
    ties_.hand_on(stiffness_);  // means are convex: D - A stays positive where it was
    for (std::size_t row = 0; row < springs_.size(); ++row) {
      for (std::size_t i = 0; i < 3; ++i) stiffness_[row][i] += springs_[row][i];
    }
    layout_.gather_rows(stiffness_.data());
    layout_.gather_cells(tangents_.data());
    bound_ = largest_of_all(*std::ranges::max_element(bounds));
    update_contact();
  }

  void apply(const MixedVector& x, MixedVector& y) const override {
    sum_over_chunks(layout_, numbers_of(y.u), [&](std::size_t c) { apply_to(layout_.chunks[c], x, y); });
    ties_.hand_on(y.u);
    for (std::size_t row = 0; row < springs_.size(); ++row) {
      for (std::size_t i = 0; i < 3; ++i) y.u[row][i] += springs_[row][i] * x.u[row][i];
    }
    for (const Spring& spring : contact_) {
      const float along = spring.extension(x.u);
      for (std::size_t n = 0; n < spring.size; ++n) {
        Row<float>& force = y.u[at(spring.nodes[n])];
        for (std::size_t i = 0; i < 3; ++i) force[i] += spring.weights[n] * along * spring.root[i];
      }
    }
  }

  void divergence(const Rows<float>& u, std::vector<float>& g) const override {
    layout_.for_each_local_chunk([&](std::size_t c) { diverge(layout_.chunks[c], u, g); });
  }

  void gradient(const std::vector<float>& p, Rows<float>& f) const override {
    sum_over_chunks(layout_, numbers_of(f), [&](std::size_t c) { add_gradients(layout_.chunks[c], p, f); });
    ties_.hand_on(f);
  }

  double largest_gradient(const Rows<float>& u) const override {
    return largest_norm(u, [](const Tensor<Number>& H) { return double_dot(H, H); });
  }

  double largest_strain(const Rows<float>& u) const override {
    return largest_norm(
        u, [](const Tensor<Number>& H) { return double_dot(weighted_strain(Number(1.0f), H), H); });
  }

 protected:
  void for_each_corner(const VisitCorner& visit) const override {
    std::vector<Column> columns;  // of an element, those of tied nodes handed on
    const std::size_t first = layout_.chunks[layout_.local_chunks.first].first,
                      last = layout_.chunks[layout_.local_chunks.last - 1].last;
    for_each_pack(layout_, first, last, [&](const StripPlace& at) {
      const NodalVectors<Number> b = nodal_gradients(elements_[at.pack]);
      const Number& V = elements_[at.pack].body.V;
      for (int lane = 0; lane < W; ++lane) {
        const std::size_t cell = at.pack * static_cast<std::size_t>(W) + static_cast<std::size_t>(lane);
        if (layout_.elements[cell] < 0) continue;
        columns.clear();
        for (std::size_t I = 0; I < std::size_t{b.rows}; ++I) {
          const std::size_t row = layout_.places(at.face + I / 4, I % 4)[lane] / 4;
          std::array<float, 3> column;
          for (int i = 0; i < 3; ++i) {
            column[static_cast<std::size_t>(i)] = Lanes<Number>::get(V * b(static_cast<int>(I), i), lane);
          }
          const auto shares = ties_.shares_of(row);
          for (const auto& [from, weight] : shares) add_column(columns, from, weight, column);
          if (shares.empty()) add_column(columns, row, 1.0f, column);
        }
        for (const auto& [row, column] : columns) visit(cell, row, column);
      }
    });
  }

 private:
  using Column = std::pair<std::size_t, std::array<float, 3>>;  // row, m^2

  static void add_column(std::vector<Column>& columns, std::size_t row, float weight,
                         const std::array<float, 3>& b) {
    auto known =
        std::find_if(columns.begin(), columns.end(), [&](const Column& c) { return c.first == row; });
    if (known == columns.end()) known = columns.insert(columns.end(), {row, {}});
    for (std::size_t i = 0; i < 3; ++i) known->second[i] += weight * b[i];
  }

  /// The largest root of square(H) for the gradients H of elements.
  template <class Square>
  double largest_norm(const Rows<float>& u, const Square& square) const {
    Number largest(0.0f);
    for (std::size_t c = layout_.own_chunks.first; c < layout_.own_chunks.last; ++c) {
      for_each_pack(layout_, layout_.chunks[c].first, layout_.chunks[c].last, [&](const StripPlace& at) {
        largest =
            max(largest, square(OnePoint::mean_gradient(modes_of(u, at.face), elements_[at.pack].body)));
      });
    }
    return std::sqrt(largest_of_all(largest_lane(largest)));
  }

  float largest_of_all(float largest) const {
    return static_cast<float>(layout_.team.ranks->largest(largest));
  }

  static float largest_lane(const Number& number) {
    float most = Lanes<Number>::get(number, 0);
    for (int lane = 1; lane < W; ++lane) most = std::max(most, Lanes<Number>::get(number, lane));
    return most;
  }

  static Number load(const std::vector<float>& values, std::size_t pack) {
    Number lanes;
    std::memcpy(static_cast<void*>(&lanes), values.data() + pack * static_cast<std::size_t>(W),
                sizeof(lanes));
    return lanes;
  }

  static void store(const Number& lanes, std::vector<float>& values, std::size_t pack) {
    std::memcpy(values.data() + pack * static_cast<std::size_t>(W), static_cast<const void*>(&lanes),
                sizeof(lanes));
  }

  /// The forces of A on the displacements with these modes, and of a pressure.
  static Modes<Number> forces(const Block& block, const Modes<Number>& u, const Tensor<Number>& H,
                              const Number& weighted_pressure) {
    Tensor<Number> T = weighted_strain(block.stress, H);
    for (int i = 0; i < 3; ++i) T(i, i) = T(i, i) + weighted_pressure;
    return OnePoint::modal_forces(T, block.hourglass * OnePoint::hourglass_displacements(u, H, block.body),
                                  block.body.c, block.body);
  }

  static Modes<Number> gradient_modes(const Block& block) {
    Modes<Number> modes{};
    for (int m = 0; m < 6; ++m) {
      for (int i = 0; i < 3; ++i) modes(m, i) = block.body.h(m, i);
    }
    return modes;
  }

  static NodalVectors<Number> nodal_gradients(const Block& block) {
    return from_modes(gradient_modes(block));
  }

  /// The block of the diagonal of A at a node whose function has the gradient g.
  static Triple<Number> diagonal(const Block& block, const NodalVectors<Number>& g, int n) {
    const Number mu_V = Number(0.5f) * block.stress;
    const Number x = g(n, 0), y = g(n, 1), z = g(n, 2);
    // The sum over the hourglass modes of gamma^2 is about that of Gamma.
    const Number same = mu_V * (x * x + y * y + z * z) + Number(4.0f) * block.hourglass;
    Triple<Number> D;
    D(0, 0) = mu_V * x * x + same;
    D(1, 0) = mu_V * y * y + same;
    D(2, 0) = mu_V * z * z + same;
    return D;
  }

  Modes<Number> modes_of(const Rows<float>& rows, std::size_t face) const {
    return modes_between(gather_face_modes<Number>(rows, layout_, face),
                         gather_face_modes<Number>(rows, layout_, face + 1));
  }

  auto gather_from(const Rows<float>& rows) const {
    return [&](std::size_t face, std::size_t /*material*/) {
      return gather_face_modes<Number>(rows, layout_, face);
    };
  }

  auto scatter_to(Rows<float>& rows) const {
    return [&](const FaceModes<Number>& sum, std::size_t face) {
      scatter_face_modes(sum, numbers_of(rows), layout_, face);
    };
  }

  SANDGLASS_HOT_LOOP void apply_to(const Layout::Chunk& chunk, const MixedVector& x, MixedVector& y) const {
    walk_strips(
        layout_, chunk.first, chunk.last, gather_from(x.u),
        [&](const auto& lower, const auto& upper, const StripPlace& at) {
          const Block& block = elements_[at.pack];
          const Modes<Number> u = modes_between(lower, upper);
          const Tensor<Number> H = OnePoint::mean_gradient(u, block.body);
          const Number p = load(x.p, at.pack);
          store(block.body.V * (H(0, 0) + H(1, 1) + H(2, 2)) - load(compliance_, at.pack) * p, y.p, at.pack);
          return on_faces(forces(block, u, H, block.body.V * p));
        },
        scatter_to(y.u));
  }

  SANDGLASS_HOT_LOOP void diverge(const Layout::Chunk& chunk, const Rows<float>& u,
                                  std::vector<float>& g) const {
    walk_strips(layout_, chunk.first, chunk.last, gather_from(u),
                [&](const auto& lower, const auto& upper, const StripPlace& at) {
                  const Block& block = elements_[at.pack];
                  const Modes<Number> modes = modes_between(lower, upper);
                  Number sum(0.0f);
                  for (int m = 0; m < 6; ++m) {
                    for (int i = 0; i < 3; ++i) sum = sum + modes(m, i) * block.body.h(m, i);
                  }
                  store(block.body.V * sum, g, at.pack);
                });
  }

  SANDGLASS_HOT_LOOP void add_gradients(const Layout::Chunk& chunk, const std::vector<float>& p,
                                        Rows<float>& f) const {
    const auto nothing = [](std::size_t /*face*/, std::size_t /*material*/) { return 0; };
    walk_strips(
        layout_, chunk.first, chunk.last, nothing,
        [&](int /*lower*/, int /*upper*/, const StripPlace& at) {
          const Block& block = elements_[at.pack];
          return on_faces((block.body.V * load(p, at.pack)) * gradient_modes(block));
        },
        scatter_to(f));
  }

  /// Bounds the eigenvalues of D^-1 A of the element alone, D the diagonal; no sum of elements has larger
  /// ones.
  static Number eigenvalue_bound(const Block& block) {
    const NodalVectors<Number> g = nodal_gradients(block);
    NodalVectors<Number> x;
    for (int I = 0; I < x.rows; ++I) {
      for (int i = 0; i < 3; ++i)
        x(I, i) = Number(1.0f + 0.37f * static_cast<float>((7 * I + 5 * i) % 11 - 5));
    }
    Number largest(1.0f);
    for (int k = 0; k < 10; ++k) {
      const Modes<Number> u = to_modes(x);
      const NodalVectors<Number> y =
          from_modes(forces(block, u, OnePoint::mean_gradient(u, block.body), Number(0.0f)));
      Number square(0.0f);
      for (int I = 0; I < x.rows; ++I) {
        const Triple<Number> D = diagonal(block, g, I);
        for (int i = 0; i < 3; ++i) {
          x(I, i) = y(I, i) / D(i, 0);
          square = square + x(I, i) * x(I, i);
        }
      }
      largest = sqrt(square);
      const Number inverse = Number(1.0f) / largest;
      for (auto& entry : x.entries) entry = entry * inverse;
    }
    return largest;
  }

  SANDGLASS_HOT_LOOP float set_blocks(const Layout::Chunk& chunk, const std::vector<ModelModuli>& moduli,
                                      const std::vector<float>& stiffening) {
    Number largest(1.0f);
    for_each_pack(layout_, chunk.first, chunk.last, [&](const StripPlace& at) {
      const auto [pack, face, material] = at;
      const auto initial_mu = static_cast<float>(moduli[material].mu),
                 lambda = static_cast<float>(moduli[material].lambda);
      const Number stiffer = load(stiffening, pack);
      const Modes<Number> x = modes_of(present_, face);
      const auto reference = OnePoint::geometry(modes_of(coordinates_, face));
      const Tensor<Number> F_inverse = inverse(OnePoint::mean_gradient(x, reference));
      Block& block = elements_[pack];
      block.body = OnePoint::geometry(x);
      block.stress = Number(2.0f * initial_mu) * stiffer * reference.V;
      block.hourglass = PerturbationStiffness::stiffness(
          Number(static_cast<float>(moduli[material].hourglass)), reference.V, block.body.h);
      if (moduli[material].hourglass_stiffens) block.hourglass = stiffer * block.hourglass;
      largest = max(largest, eigenvalue_bound(block));
      for (int lane = 0; lane < W; ++lane) {
        const std::size_t cell = pack * static_cast<std::size_t>(W) + static_cast<std::size_t>(lane);
        if (layout_.elements[cell] < 0) continue;
        ElementTangent& tangent = tangents_[cell];
        for (std::size_t n = 0; n < 9; ++n)
          tangent.inverse[n] = Lanes<Number>::get(F_inverse.entries[n], lane);
        tangent.volume = Lanes<Number>::get(reference.V, lane);
        tangent.jacobian = Lanes<Number>::get(block.body.V, lane) / tangent.volume;
        tangent.mu = initial_mu * stiffening[cell];
        tangent.lambda = lambda;
        compliance_[cell] = tangent.volume / lambda;
      }
    });
    return 1.05f * largest_lane(largest);
  }

  SANDGLASS_HOT_LOOP void add_diagonals(const Layout::Chunk& chunk) {
    for_each_pack(layout_, chunk.first, chunk.last, [&](const StripPlace& at) {
      const NodalVectors<Number> g = nodal_gradients(elements_[at.pack]);
      for (std::size_t I = 0; I < std::size_t{g.rows}; ++I) {
        const Triple<Number> D = diagonal(elements_[at.pack], g, static_cast<int>(I));
        scatter_add<Number>({D(0, 0), D(1, 0), D(2, 0)}, numbers_of(stiffness_),
                            layout_.places(at.face + I / 4, I % 4));
      }
    });
  }

  Rows<float> coordinates_;  // m
  Rows<float> present_;      // m
  std::vector<Block> elements_;
};

}  // namespace

std::unique_ptr<ElementLevel> make_element_level(const Mesh& mesh, const Ties& ties, const Layout& layout,
                                                 const Rows<float>& free, const Rows<float>& springs) {
  switch (layout.width) {
    case 1:
      return std::make_unique<Elements<1>>(mesh, ties, layout, free, springs);
    case 2:
      return std::make_unique<Elements<2>>(mesh, ties, layout, free, springs);
    case 4:
      return std::make_unique<Elements<4>>(mesh, ties, layout, free, springs);
    case 8:
      return std::make_unique<Elements<8>>(mesh, ties, layout, free, springs);
    case 16:
      return std::make_unique<Elements<16>>(mesh, ties, layout, free, springs);
    default:
      throw std::logic_error(fmt::format("no elements of the finest level for {} lanes", layout.width));
  }
}

}  // namespace sandglass
