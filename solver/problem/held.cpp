#include "problem/held.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "mesh/oddities.hpp"
#include "mesh/parts.hpp"
#include "mesh/vectors.hpp"

namespace sandglass {

namespace {

/// Directions and points are described up to this share of a piece.
constexpr double resolved = 1e-4;

/// Numbers without the noise of what they were computed from, whose size is `scale`.
double tidy(double x, double scale) {
  const double unit = resolved * scale;
  return std::abs(x) < unit ? 0.0 : x;
}

std::string point_text(const Vector& X, double scale) {
  return fmt::format("({:.4g}, {:.4g}, {:.4g}) m", tidy(X[0], scale), tidy(X[1], scale), tidy(X[2], scale));
}

std::string direction_text(Vector d) {
  const double norm = length(d);
  for (double& x : d) x = tidy(x / norm, 1.0);
  for (std::size_t i = 0; i < 3; ++i)
    if (std::abs(d[i]) > 1.0 - resolved * resolved) return std::string(1, "xyz"[i]);
  return fmt::format("({:.3g}, {:.3g}, {:.3g})", d[0], d[1], d[2]);
}

/// The rotations and translations that span the motions of one piece.
struct Basis {
  std::vector<RigidMotion> rotations;
  std::vector<Vector> translations;
};

/// Gauss-Jordan elimination with full pivoting, of rotations first, so that unit vectors along the axes are
/// found where there are any.
Basis basis_of(const std::vector<RigidMotion>& motions) {
  std::vector<std::array<double, 6>> rows, done;
  for (const RigidMotion& m : motions) {
    rows.push_back(
        {m.rotation[0], m.rotation[1], m.rotation[2], m.translation[0], m.translation[1], m.translation[2]});
  }
  const auto eliminate = [&](std::size_t first, std::size_t last) {
    for (;;) {
      std::size_t row = 0, column = first;
      double largest = resolved;
      for (std::size_t r = 0; r < rows.size(); ++r) {
        for (std::size_t c = first; c < last; ++c) {
          if (std::abs(rows[r][c]) <= largest * (1.0 + resolved)) continue;
          largest = std::abs(rows[r][c]);
          row = r;
          column = c;
        }
      }
      if (largest == resolved) return;
      auto pivot = rows[row];
      for (const double d = pivot[column]; double& x : pivot) x /= d;
      rows.erase(rows.begin() + static_cast<std::ptrdiff_t>(row));
      for (auto* all : {&rows, &done}) {
        for (auto& other : *all) {
          const double share = other[column];
          for (std::size_t c = 0; c < 6; ++c) other[c] -= share * pivot[c];
        }
      }
      done.push_back(pivot);
    }
  };
  Basis basis;
  eliminate(0, 3);
  const std::size_t rotations = done.size();
  eliminate(3, 6);
  for (std::size_t k = 0; k < done.size(); ++k) {
    const auto& r = done[k];
    if (k < rotations) {
      basis.rotations.push_back({{r[3], r[4], r[5]}, {r[0], r[1], r[2]}});
    } else {
      basis.translations.push_back({r[3], r[4], r[5]});
    }
  }
  return basis;
}

/// A point of the axis of a rotation, nearest to the centre of the piece, m.
Vector on_axis(const RigidMotion& motion, const RigidPiece& piece) {
  const Vector& w = motion.rotation;
  Vector X = cross(w, motion.translation);
  for (std::size_t i = 0; i < 3; ++i) X[i] = piece.centre[i] + X[i] * piece.radius / dot(w, w);
  return X;
}

std::string rotation_text(const RigidMotion& motion, const RigidPiece& piece, bool with_place) {
  const Vector& w = motion.rotation;
  std::string text = "rotation about " + direction_text(w);
  if (!with_place) return text;
  text += " through " + point_text(on_axis(motion, piece), piece.radius + length(piece.centre));
  const double pitch = dot(w, motion.translation) / dot(w, w) * piece.radius;
  if (std::abs(pitch) > resolved * piece.radius)
    text += fmt::format(" with {:.3g} m along it per rad", pitch);
  return text;
}

/// The motions of a piece in words.
std::string motions_text(const std::vector<RigidMotion>& motions, const RigidPiece& piece) {
  const Basis basis = basis_of(motions);
  const std::vector<RigidMotion>& rotations = basis.rotations;
  const std::vector<Vector>& translations = basis.translations;
  if (rotations.size() + translations.size() == 6) return "every translation and rotation";
  std::vector<std::string> words, directions;
  for (const Vector& t : translations) directions.push_back(direction_text(t));
  std::ranges::sort(directions);
  if (!directions.empty())
    words.push_back(fmt::format("translation along {}", fmt::join(directions, " and ")));
  if (rotations.size() == 3 && translations.empty()) {
    // The rotations about x, y and z: they have a point in common if anything is held there.
    Vector X = piece.centre;
    const auto about = [&](std::size_t axis) {
      return *std::ranges::max_element(rotations, {}, [&](const RigidMotion& m) { return m.rotation[axis]; });
    };
    const Vector offset{about(1).translation[2], -about(0).translation[2], about(0).translation[1]};
    for (std::size_t i = 0; i < 3; ++i) X[i] += piece.radius * offset[i];
    const bool common = std::ranges::all_of(
        rotations, [&](const RigidMotion& m) { return length(displacement_of(m, piece, X)) < 1e-3; });
    if (common)
      return "rotation about every axis through " + point_text(X, piece.radius + length(piece.centre));
  }
  // Where a translation across the axis is free as well, the axis has no place.
  for (const RigidMotion& m : rotations) {
    const bool placed = std::ranges::all_of(translations, [&](const Vector& t) {
      return length(cross(t, m.rotation)) < resolved * length(t) * length(m.rotation);
    });
    words.push_back(rotation_text(m, piece, placed));
  }
  return fmt::format("{}", fmt::join(words, ", "));
}

std::string place_of(const RigidPiece& piece, const Mesh& mesh) {
  const std::size_t own = piece.elements.size(), all = mesh.cells.size();
  return own == all
             ? "the body"
             : fmt::format("{} of {} elements around {}", own, all, point_text(piece.centre, piece.radius));
}

/// Of how many elements of a piece the nodes are considered.
constexpr std::size_t most_looked_at = 10000;

/// Nodes and components that would hold a body without any stress: at each step the one that moves most.
std::string remedy(const LooseBody& body, const Mesh& mesh) {
  struct Place {
    Vector X;
    std::string components;
  };
  std::map<int, Place> chosen;
  auto motions = body.motions;
  const auto moved = [&](std::size_t m, std::size_t p, const Vector& X) {
    return displacement_of(motions[m][p], body.pieces[p], X);
  };
  while (!motions.empty()) {
    double largest = 0.0;
    int node = 0;
    std::size_t component = 0, piece = 0;
    for (std::size_t p = 0; p < body.pieces.size(); ++p) {
      const std::vector<int>& elements = body.pieces[p].elements;
      for (std::size_t k = 0; k < elements.size(); k += 1 + elements.size() / most_looked_at) {
        for (const int n : mesh.cells[at(elements[k])]) {
          Vector square{};
          for (std::size_t m = 0; m < motions.size(); ++m) {
            const Vector u = moved(m, p, mesh.points[at(n)]);
            for (std::size_t i = 0; i < 3; ++i) square[i] += u[i] * u[i];
          }
          for (std::size_t i = 0; i < 3; ++i) {
            const double weight = chosen.contains(n) ? 4.0 * square[i] : square[i];  // few nodes are easier
            if (weight <= largest * (1.0 + resolved)) continue;
            largest = weight;
            node = n;
            component = i;
            piece = p;
          }
        }
      }
    }
    const Vector& X = mesh.points[at(node)];
    chosen.try_emplace(node, Place{X, ""}).first->second.components += "xyz"[component];
    std::vector<double> along;
    for (std::size_t m = 0; m < motions.size(); ++m) along.push_back(moved(m, piece, X)[component]);
    const auto pivot = static_cast<std::size_t>(
        std::ranges::max_element(along, {}, [](double x) { return std::abs(x); }) - along.begin());
    const auto removed = motions[pivot];
    for (std::size_t m = 0; m < motions.size(); ++m) {
      for (std::size_t p = 0; p < body.pieces.size(); ++p) {
        for (std::size_t i = 0; i < 3; ++i) {
          motions[m][p].translation[i] -= along[m] / along[pivot] * removed[p].translation[i];
          motions[m][p].rotation[i] -= along[m] / along[pivot] * removed[p].rotation[i];
        }
      }
    }
    motions.erase(motions.begin() + static_cast<std::ptrdiff_t>(pivot));
  }
  std::vector<std::string> words;
  for (auto& [node, place] : chosen) {
    std::ranges::sort(place.components);
    words.push_back(fmt::format("{} of node {} at ({:.6g}, {:.6g}, {:.6g}) m", place.components, node,
                                place.X[0], place.X[1], place.X[2]));
  }
  return fmt::format("{}", fmt::join(words, ", "));
}

/// What some loose bodies may do, in words.
std::string described(const std::vector<LooseBody>& loose, const Mesh& mesh, bool with_remedy) {
  constexpr std::size_t most = 3;
  std::string text;
  for (std::size_t b = 0; b < std::min(loose.size(), most); ++b) {
    const LooseBody& body = loose[b];
    for (std::size_t p = 0; p < std::min(body.pieces.size(), most); ++p) {
      std::vector<RigidMotion> motions;
      for (const auto& of_pieces : body.motions) motions.push_back(of_pieces[p]);
      text += fmt::format("{}{} against {}", text.empty() ? "" : "; nothing holds ",
                          place_of(body.pieces[p], mesh), motions_text(motions, body.pieces[p]));
    }
    if (body.pieces.size() > most) {
      text += fmt::format("; and {} more pieces, joined to these by edges, single nodes or ties",
                          body.pieces.size() - most);
    }
    if (with_remedy) text += fmt::format(" (to hold it, impose for instance {})", remedy(body, mesh));
  }
  if (loose.size() > most) text += fmt::format("; and {} more", loose.size() - most);
  return text;
}

}  // namespace

std::vector<LooseBody> free_motions(const Scene& scene) {
  std::vector<Hold> holds;
  holds.reserve(scene.constraints.size());
  for (const Constraint& constraint : scene.constraints) {
    Vector direction{};
    direction[at(constraint.component)] = 1.0;
    holds.push_back({{{constraint.node, 1.0}}, direction});
  }
  for (const auto& force : scene.forces) force->add_holds(holds);
  return free_motions(scene.mesh, scene.ties, holds);
}

std::string described_free_motions(const Scene& scene) {
  return described(free_motions(scene), scene.mesh, false);
}

void require_held(const Scene& scene) {
  const std::vector<LooseBody> loose = free_motions(scene);
  if (loose.empty()) return;
  const int parts = number_of_parts(scene.mesh, scene.ties);
  std::string of_parts;
  if (parts > 1) {
    const std::string seam = described(seam_of(scene.mesh, scene.ties, scene.boundary), scene.mesh);
    of_parts = fmt::format("this one has {} elements in {} parts; {}{}", scene.mesh.cells.size(), parts, seam,
                           seam.empty() ? "" : "; ");
  }
  throw InputError(fmt::format(
      "{}: a body at rest must be held against every motion as a whole, by [[displacement]], [[rotation]], "
      "[[support]] with a stiffness, an [[obstacle]] that it touches undeformed, or [[tie]] or [[contact]] "
      "to a part that is held; {}nothing holds {}",
      scene.settings.file.string(), of_parts, described(loose, scene.mesh, true)));
}

}  // namespace sandglass
