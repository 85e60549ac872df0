#include "mesh/free_motions.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include "math/dense.hpp"
#include "mesh/disjoint_sets.hpp"
#include "mesh/node_elements.hpp"
#include "mesh/vectors.hpp"

namespace sandglass {

namespace {

/// A motion counts as free if it moves all holds by at most this fraction of itself.
constexpr double tolerance = 1e-5;

constexpr std::size_t most_pieces = 100;

using Unknowns = std::array<double, 6>;  // of a piece: translation and rotation

using Coefficients = std::vector<double>;

double product(std::span<const double> a, std::span<const double> b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

/// Vectors of length one that span the motions of n unknowns that all rows leave free; each row is the
/// displacement of a hold or joint as a linear function of the unknowns. They are eigenvectors of the
/// products of columns, whose eigenvalues are sums of squares over the rows: the tolerance squared is far
/// above roundoff.
std::vector<Coefficients> null_space(const std::vector<Coefficients>& rows, std::size_t n) {
  std::vector<double> products(n * n);
  constexpr std::size_t block = 512;  // long sums would round more
  for (std::size_t first = 0; first < rows.size(); first += block) {
    std::vector<double> sums(n * n);
    for (std::size_t k = first; k < std::min(first + block, rows.size()); ++k) {
      for (std::size_t i = 0; i < n; ++i) {
        if (rows[k][i] == 0.0) continue;
        for (std::size_t j = 0; j < n; ++j) sums[i * n + j] += rows[k][i] * rows[k][j];
      }
    }
    for (std::size_t k = 0; k < products.size(); ++k) products[k] += sums[k];
  }
  const Eigenpairs pairs = symmetric_eigenpairs(products);
  const double most = tolerance * tolerance * static_cast<double>(rows.size());
  std::vector<Coefficients> free;
  for (std::size_t k = 0; k < n; ++k) {
    const Coefficients& motion = pairs.vectors[k];
    const auto moved = [&](const Coefficients& row) { return std::abs(product(row, motion)) > tolerance; };
    // The mean square is at most the largest, and needs no second pass over the rows.
    if (pairs.values[k] <= most && std::ranges::none_of(rows, moved)) free.push_back(motion);
  }
  return free;
}

/// Elements that are rigid together, and their joints with others.
class Pieces {
 public:
  Pieces(const Mesh& mesh, const Ties& ties) : mesh_(mesh), sets_(mesh.cells.size()) {
    const NodeElements elements(mesh);
    join_by_faces(elements);
    for (std::size_t n = 0; n < mesh.points.size(); ++n) node_element_.push_back(first_of(elements, n));
    add_shared_nodes(elements);
    add_ties(ties);
    while (join_by_points()) {
    }
    number();
  }

  std::size_t count() const { return pieces_.size(); }
  const RigidPiece& operator[](std::size_t p) const { return pieces_[p]; }

  /// A piece to which a node belongs; none for a node without elements.
  std::optional<std::size_t> of_node(int node) const {
    const int element = node_element_[at(node)];
    if (element < 0) return std::nullopt;
    return of_element(element);
  }

  /// Adds to a row the displacement in a direction at a point of a piece, as a function of its six unknowns.
  void add(const Vector& X, const Vector& direction, double factor, std::size_t piece, Unknowns& row) const {
    const auto& [elements, centre, radius] = pieces_[piece];
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
      row[i] += factor * direction[i];
      row[3 + i] += factor * ((X[j] - centre[j]) * direction[k] - (X[k] - centre[k]) * direction[j]) / radius;
    }
  }

  std::size_t of_element(int element) const { return at(piece_of_element_[at(element)]); }

  /// Points on a line at which two pieces are joined, by an element of each.
  const std::map<std::pair<int, int>, NodalField>& joints() const { return joints_; }

  /// Ties to nodes of several pieces.
  const Ties& other_ties() const { return other_ties_; }

 private:
  static int first_of(const NodeElements& elements, std::size_t node) {
    const auto around = elements.around(static_cast<int>(node));
    return around.empty() ? -1 : around.front();
  }

  void join_by_faces(const NodeElements& elements) {
    // Three corners of a face are not on a line.
    constexpr std::array<std::array<std::size_t, 3>, 6> faces{
        {{0, 3, 2}, {4, 5, 6}, {0, 1, 5}, {1, 2, 6}, {2, 3, 7}, {3, 0, 4}}};
    const auto has = [&](int node, int element) {
      return std::ranges::binary_search(elements.around(node), element);
    };
    for (int e = 0; e < static_cast<int>(mesh_.cells.size()); ++e) {
      const Hexahedron& cell = mesh_.cells[at(e)];
      for (const auto& [a, b, c] : faces) {
        for (const int other : elements.around(cell[a]))
          if (other > e && has(cell[b], other) && has(cell[c], other)) sets_.join(e, other);
      }
    }
  }

  void add_shared_nodes(const NodeElements& elements) {
    for (std::size_t n = 0; n < mesh_.points.size(); ++n) {
      std::set<int> others;
      for (const int element : elements.around(static_cast<int>(n))) others.insert(sets_.least(element));
      for (const int other : others) add_joint(node_element_[n], other, mesh_.points[n]);
    }
  }

  void add_ties(const Ties& ties) {
    for (const Tie& tie : ties) {
      const int own = node_element_[at(tie.node)];
      if (own < 0) continue;
      std::set<int> followed;
      Vector X{};
      for (const auto& [node, weight] : tie.mean_of) {
        if (node_element_[at(node)] >= 0) followed.insert(sets_.least(node_element_[at(node)]));
        for (std::size_t i = 0; i < 3; ++i) X[i] += weight * mesh_.points[at(node)][i];
      }
      if (followed.size() == 1) {
        add_joint(own, *followed.begin(), X);
      } else {
        other_ties_.push_back(tie);
      }
    }
  }

  void add_joint(int a, int b, const Vector& X) {
    const auto [low, high] = std::minmax({sets_.least(a), sets_.least(b)});
    if (low != high) joints_[{low, high}].push_back(X);
  }

  /// Joins pieces whose joints are not on a line; returns whether there were any.
  bool join_by_points() {
    const auto before = std::exchange(joints_, {});
    bool joined = false;
    for (const auto& [pair, points] : before) {
      if (on_a_line(points)) continue;
      sets_.join(pair.first, pair.second);
      joined = true;
    }
    for (const auto& [pair, points] : before) {
      for (const Vector& X : points) add_joint(pair.first, pair.second, X);
    }
    return joined;
  }

  static bool on_a_line(const NodalField& points) {
    Vector along{};
    for (const Vector& X : points) {
      const Vector arm = difference(X, points[0]);
      if (dot(arm, arm) > dot(along, along)) along = arm;
    }
    const double squared_length = dot(along, along);
    double off = 0.0;  // squared
    for (const Vector& X : points) {
      const Vector arm = difference(X, points[0]);
      const Vector beside = sum(arm, -dot(along, arm) / squared_length, along);
      off = std::max(off, dot(beside, beside));
    }
    return !(off > tolerance * tolerance * squared_length);
  }

  void number() {
    for (int e = 0; e < static_cast<int>(mesh_.cells.size()); ++e) {
      const int least = sets_.least(e);
      piece_of_element_.push_back(least < e ? piece_of_element_[at(least)]
                                            : static_cast<int>(pieces_.size()));
      if (least == e) pieces_.emplace_back();
      pieces_[of_element(e)].elements.push_back(e);
    }
    for (RigidPiece& piece : pieces_) {
      NodalField corners;
      for (const int e : piece.elements) {
        for (const int node : mesh_.cells[at(e)]) corners.push_back(mesh_.points[at(node)]);
      }
      const auto [low, high] = bounding_box(corners);
      for (std::size_t i = 0; i < 3; ++i) piece.centre[i] = 0.5 * (low[i] + high[i]);
      piece.radius = 0.5 * distance(low, high);
    }
  }

  const Mesh& mesh_;
  DisjointSets sets_;              // of elements
  std::vector<int> node_element_;  // one around each node, or -1
  std::map<std::pair<int, int>, NodalField> joints_;
  Ties other_ties_;
  std::vector<int> piece_of_element_;
  std::vector<RigidPiece> pieces_;
};

/// A linear function of the unknowns of some pieces that must be zero.
using Equation = std::map<std::size_t, Unknowns>;

/// Adds the mean displacement of nodes in a direction, times a factor, to an equation.
void add_mean(const Mesh& mesh, const Pieces& pieces, const std::vector<Tie::Share>& mean_of,
              const Vector& direction, double factor, Equation& equation) {
  for (const auto& [node, weight] : mean_of) {
    const auto piece = pieces.of_node(node);
    if (!piece) continue;
    auto& row = equation[*piece];
    pieces.add(mesh.points[at(node)], direction, factor * weight, *piece, row);
  }
}

/// The unknowns of a piece among those of its group: factors of its free motions.
struct Columns {
  std::size_t first;
  const std::vector<Coefficients>* motions;
};

/// The rows of equations in the unknowns of a group.
std::vector<Coefficients> rows_of(const std::vector<const Equation*>& equations,
                                  const std::map<std::size_t, Columns>& columns, std::size_t unknowns) {
  std::vector<Coefficients> rows(equations.size(), Coefficients(unknowns));
  for (std::size_t k = 0; k < equations.size(); ++k) {
    for (const auto& [piece, row] : *equations[k]) {
      const auto found = columns.find(piece);
      if (found == columns.end()) continue;
      const auto& [first, motions] = found->second;
      for (std::size_t m = 0; m < motions->size(); ++m) rows[k][first + m] = product(row, (*motions)[m]);
    }
  }
  return rows;
}

/// The motion of a piece in one of those of its group.
Unknowns motion_within(const Columns& columns, const Coefficients& of_group) {
  Unknowns motion{};
  for (std::size_t m = 0; m < columns.motions->size(); ++m) {
    for (std::size_t i = 0; i < motion.size(); ++i)
      motion[i] += of_group[columns.first + m] * (*columns.motions)[m][i];
  }
  return motion;
}

}  // namespace

std::vector<LooseBody> free_motions(const Mesh& mesh, const Ties& ties, const std::vector<Hold>& holds) {
  const Pieces pieces(mesh, ties);
  // Holds of single pieces.
  std::vector<std::vector<Coefficients>> own(pieces.count());
  std::vector<Equation> joint;
  const auto add_equation = [&](Equation equation) {
    if (equation.size() == 1) {
      const auto& [piece, row] = *equation.begin();
      own[piece].emplace_back(row.begin(), row.end());
    } else if (!equation.empty()) {
      joint.push_back(std::move(equation));
    }
  };
  for (const Hold& hold : holds) {
    Equation equation;
    add_mean(mesh, pieces, hold.mean_of, hold.direction, 1.0, equation);
    add_equation(std::move(equation));
  }
  // Joints between pieces.
  for (const auto& [pair, points] : pieces.joints()) {
    const std::size_t a = pieces.of_element(pair.first), b = pieces.of_element(pair.second);
    for (const Vector& X : points) {
      for (const Vector& axis : coordinate_axes) {
        Equation equation;
        pieces.add(X, axis, 1.0, a, equation[a]);
        pieces.add(X, axis, -1.0, b, equation[b]);
        add_equation(std::move(equation));
      }
    }
  }
  for (const Tie& tie : pieces.other_ties()) {
    for (const Vector& axis : coordinate_axes) {
      Equation equation;
      add_mean(mesh, pieces, {{tie.node, 1.0}}, axis, 1.0, equation);
      add_mean(mesh, pieces, tie.mean_of, axis, -1.0, equation);
      add_equation(std::move(equation));
    }
  }
  std::vector<std::vector<Coefficients>> free;
  for (const auto& rows : own) free.push_back(null_space(rows, 6));
  // Groups of pieces that are joined and not held.
  DisjointSets sets(pieces.count());
  for (const Equation& equation : joint) {
    std::optional<int> first;
    for (const auto& [piece, row] : equation) {
      if (free[piece].empty()) continue;
      if (first) sets.join(*first, static_cast<int>(piece));
      first = static_cast<int>(piece);
    }
  }
  struct Group {
    std::map<std::size_t, Columns> columns;
    std::size_t unknowns = 0;
    std::vector<const Equation*> equations;
  };
  std::map<int, Group> groups;
  for (std::size_t p = 0; p < pieces.count(); ++p) {
    if (free[p].empty()) continue;
    Group& group = groups[sets.least(static_cast<int>(p))];
    group.columns[p] = {group.unknowns, &free[p]};
    group.unknowns += free[p].size();
  }
  for (const Equation& equation : joint) {
    for (const auto& [piece, row] : equation) {
      if (free[piece].empty()) continue;
      groups.at(sets.least(static_cast<int>(piece))).equations.push_back(&equation);
      break;
    }
  }
  std::vector<LooseBody> loose;
  for (const auto& [least, group] : groups) {
    if (group.columns.size() > most_pieces) continue;
    const auto basis = null_space(rows_of(group.equations, group.columns, group.unknowns), group.unknowns);
    if (basis.empty()) continue;
    LooseBody body;
    body.motions.resize(basis.size());
    for (const auto& [piece, columns] : group.columns) {
      std::vector<Unknowns> motions;
      double largest = 0.0;
      for (const Coefficients& motion : basis) {
        motions.push_back(motion_within(columns, motion));
        for (const double part : motions.back()) largest = std::max(largest, std::abs(part));
      }
      if (largest <= tolerance) continue;  // held by the others
      body.pieces.push_back(pieces[piece]);
      for (std::size_t m = 0; m < basis.size(); ++m) {
        const auto& [x, y, z, a, b, c] = motions[m];
        body.motions[m].push_back({{x, y, z}, {a, b, c}});
      }
    }
    loose.push_back(std::move(body));
  }
  return loose;
}

Vector displacement_of(const RigidMotion& motion, const RigidPiece& piece, const Vector& X) {
  Vector u = motion.translation;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    u[i] += (motion.rotation[j] * (X[k] - piece.centre[k]) - motion.rotation[k] * (X[j] - piece.centre[j])) /
            piece.radius;
  }
  return u;
}

}  // namespace sandglass
