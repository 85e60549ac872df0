#include "solve/preconditioner.hpp"

#include "assembly/face_gather.hpp"
#include "element/one_point.hpp"
#include "solve/row_loops.hpp"

namespace sandglass {

namespace {

/// The numbers per element for the coarse stiffness: F^-1 and V.
constexpr std::size_t tangent_numbers = 10;

/// The share of an element's stiffness bound in its nodal blocks, which resists hourglassing.
constexpr double bound_share = 0.25;

}  // namespace

template <class Real>
Preconditioner<Real>::Preconditioner(const Model& model, const InternalForce<Real>& elements,
                                     const Body<Real>& body)
    : layout_(elements.layout()),
      lambda_(std::visit([](const auto& law) { return lame_lambda(law); }, model.scene().description.law)),
      mu_(std::visit([](const auto& law) { return law.shear_modulus(); }, model.scene().description.law)),
      coordinates_(centred_coordinates<Real>(model.scene().mesh.points, layout_)),
      free_(body.on_free_components(std::vector<double>(layout_.nodes, 1.0))),
      diagonal_(layout_.rows()),
      mixed_(layout_.rows()),
      tangents_(tangent_numbers * layout_.elements.size()),
      place_of_element_(model.scene().mesh.cells.size()),
      transfer_(CoarseGrid(model.scene().mesh.points), model.scene().mesh.points, layout_),
      stiffness_(model.scene(), CoarseGrid(model.scene().mesh.points)) {
  const auto width = static_cast<std::size_t>(layout_.width);
  for (std::size_t k = 0; k < layout_.elements.size(); ++k) {
    if (layout_.elements[k] < 0) continue;
    place_of_element_[static_cast<std::size_t>(layout_.elements[k])] =
        k / width * width * tangent_numbers + k % width;
  }
}

template <class Real>
void Preconditioner<Real>::update(Body<Real>& body) {
  const std::vector<double>& bounds = body.stiffness_bounds();
  clear(diagonal_, body.threads());
  clear(mixed_, body.threads());
  if (layout_.width == 1) {
    add_elements<Real>(body, bounds);
  } else {
    add_elements<Pack<Real>>(body, bounds);
  }
  invert_blocks(body.threads());
  stiffness_.update([&](std::size_t element) { return tangent_of(element); }, body.threads());
}

template <class Real>
template <class Number>
void Preconditioner<Real>::add_elements(const Body<Real>& body, const std::vector<double>& bounds) {
  for (const std::size_t colour : {0U, 1U}) {
    const std::size_t chunks = (layout_.chunks.size() + 1 - colour) / 2;
    in_parallel(chunks, body.threads(),
                [&](std::size_t c) { add_chunk<Number>(layout_.chunks[2 * c + colour], body, bounds); });
  }
}

/// Adds V ((lambda + mu) g g^T + mu |g|^2 I) at each node, with g the spatial gradient of its function, and a
/// share of the stiffness bound.
template <class Real>
template <class Number>
[[gnu::flatten]] void Preconditioner<Real>::add_chunk(const Layout::Chunk& chunk, const Body<Real>& body,
                                                      const std::vector<double>& bounds) {
  constexpr int width = Lanes<Number>::width;
  for (std::size_t group = chunk.first; group < chunk.last; ++group) {
    const auto [first_rank, first_face, ranks] = layout_.groups[group];
    for (std::size_t k = 0; k < ranks; ++k) {
      const std::size_t face = first_face + k, rank = first_rank + k;
      const auto modes = [&](const Rows<Real>& rows) {
        return modes_between(gather_face_modes<Number>(rows, layout_, face),
                             gather_face_modes<Number>(rows, layout_, face + 1));
      };
      const auto element = OnePoint::geometry(modes(coordinates_));
      const Tensor<Number> F_inverse =
          inverse(identity<Number>() + OnePoint::mean_gradient(modes(body.state().u), element));
      const NodalVectors<Number> g = from_modes(OnePoint::body_forces(F_inverse, element));
      Number bound(Real(0));
      for (int lane = 0; lane < width; ++lane) {
        const auto place = rank * width + static_cast<std::size_t>(lane);
        const int e = layout_.elements[place];
        if (e < 0) continue;
        Lanes<Number>::set(bound, lane, static_cast<Real>(bounds[static_cast<std::size_t>(e)]));
      }
      const Number firm = Number(static_cast<Real>(bound_share / 8.0)) * bound;
      const Number mu = Number(static_cast<Real>(mu_)) * element.V;
      const Number outer = Number(static_cast<Real>(lambda_ + mu_)) * element.V;
      for (int I = 0; I < 8; ++I) {
        const Number x = g(I, 0), y = g(I, 1), z = g(I, 2);
        const Number same = mu * (x * x + y * y + z * z) + firm;
        const Place* places =
            layout_.places(face + static_cast<std::size_t>(I) / 4, static_cast<std::size_t>(I) % 4);
        scatter_add<Number>({outer * x * x + same, outer * y * y + same, outer * z * z + same},
                            numbers_of(diagonal_), places);
        scatter_add<Number>({outer * y * z, outer * z * x, outer * x * y}, numbers_of(mixed_), places);
      }
      Real* tangent = tangents_.data() + rank * tangent_numbers * width;
      std::memcpy(tangent, &F_inverse, sizeof F_inverse);
      std::memcpy(tangent + 9 * width, &element.V, sizeof element.V);
    }
  }
}

/// Inverts the blocks by cofactors without constrained components, whose entries become zero.
template <class Real>
void Preconditioner<Real>::invert_blocks(int threads) {
  for_each_block(4 * free_.size(), threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t r = first / 4; r < last / 4; ++r) {
      Row<Real>&d = diagonal_[r], &m = mixed_[r];
      const Row<Real>& f = free_[r];
      for (std::size_t i = 0; i < 3; ++i) {
        d[i] = f[i] * d[i] + (Real(1) - f[i]);
        m[i] *= f[(i + 1) % 3] * f[(i + 2) % 3];
      }
      const Row<Real> D = d, M = m;
      const auto cofactor = [&](std::size_t i) { return D[(i + 1) % 3] * D[(i + 2) % 3] - M[i] * M[i]; };
      const auto mixed_cofactor = [&](std::size_t i) {
        return M[(i + 1) % 3] * M[(i + 2) % 3] - M[i] * D[i];
      };
      const Real scale = Real(1) / (D[0] * cofactor(0) + M[1] * mixed_cofactor(1) + M[2] * mixed_cofactor(2));
      for (std::size_t i = 0; i < 3; ++i) {
        d[i] = f[i] * (scale * cofactor(i));
        m[i] = scale * mixed_cofactor(i);
      }
    }
  });
}

template <class Real>
ElementTangent Preconditioner<Real>::tangent_of(std::size_t element) const {
  const Real* const first = tangents_.data() + place_of_element_[element];
  const auto width = static_cast<std::size_t>(layout_.width);
  ElementTangent tangent;
  for (std::size_t n = 0; n < 9; ++n) tangent.inverse.entries[n] = static_cast<double>(first[n * width]);
  tangent.volume = static_cast<double>(first[9 * width]);
  return tangent;
}

template class Preconditioner<double>;
template class Preconditioner<float>;

}  // namespace sandglass
