#include "forces/triangle_surface.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>

#include "base/error.hpp"
#include "forces/triangle_foot.hpp"

namespace sandglass {

namespace {

std::string text_of(const Vector& x) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", x[0], x[1], x[2]);
}

constexpr int most_in_leaf = 4;

/// The mean of the corners of each triangle, m.
NodalField centres_of(const NodalField& points, const std::vector<Triangle>& triangles) {
  NodalField centres;
  for (const Triangle& corners : triangles) centres.push_back(mean_at(corners, points));
  return centres;
}

/// Points and triangles as they are read; equal points are one.
struct Soup {
  NodalField points = {};
  std::vector<Triangle> triangles = {};
  std::map<Vector, int> known = {};

  int number_of(const Vector& X) {
    const auto [place, is_new] = known.try_emplace(X, static_cast<int>(points.size()));
    if (is_new) points.push_back(X);
    return place->second;
  }
};

Soup read_binary_stl(const std::string& bytes) {
  Soup soup;
  for (std::size_t at_triangle = 84; at_triangle + 50 <= bytes.size(); at_triangle += 50) {
    std::array<float, 12> numbers{};
    std::memcpy(numbers.data(), bytes.data() + at_triangle, sizeof numbers);
    Triangle corners{};
    for (std::size_t I = 0; I < 3; ++I) {
      const float* X = numbers.data() + 3 + 3 * I;
      corners[I] =
          soup.number_of({static_cast<double>(X[0]), static_cast<double>(X[1]), static_cast<double>(X[2])});
    }
    soup.triangles.push_back(corners);
  }
  return soup;
}

Soup read_text_stl(std::istream& text) {
  Soup soup;
  std::vector<int> corners;
  for (std::string word; text >> word;) {
    if (word != "vertex") continue;
    Vector X{};
    text >> X[0] >> X[1] >> X[2];
    if (text) corners.push_back(soup.number_of(X));
  }
  for (std::size_t n = 0; n + 2 < corners.size(); n += 3)
    soup.triangles.push_back({corners[n], corners[n + 1], corners[n + 2]});
  return soup;
}

Soup read_obj(std::istream& text) {
  Soup soup;
  std::vector<int> numbers;  // of the points of the file
  for (std::string line; std::getline(text, line);) {
    std::istringstream words(line);
    std::string word;
    words >> word;
    if (word == "v") {
      Vector X{};
      words >> X[0] >> X[1] >> X[2];
      if (!words) throw InputError(fmt::format("'{}' must have three coordinates", line));
      numbers.push_back(soup.number_of(X));
    }
    if (word != "f") continue;
    std::vector<int> corners;
    for (std::string corner; words >> corner;) {
      const long number = std::strtol(corner.c_str(), nullptr, 10), count = static_cast<long>(numbers.size());
      const long place = number < 0 ? count + number : number - 1;
      if (place < 0 || place >= count)
        throw InputError(fmt::format("'{}' names a point that is not there", line));
      corners.push_back(numbers[static_cast<std::size_t>(place)]);
    }
    for (std::size_t n = 2; n < corners.size(); ++n)
      soup.triangles.push_back({corners[0], corners[n - 1], corners[n]});
  }
  return soup;
}

}  // namespace

TriangleSurface::TriangleSurface(NodalField points, std::vector<Triangle> triangles, const std::string& file)
    : points_(std::move(points)),
      triangles_(std::move(triangles)),
      tree_(centres_of(points_, triangles_), most_in_leaf),
      boxes_(tree_.rows()) {
  if (triangles_.empty()) throw InputError(fmt::format("{}: no triangle; allowed: a closed surface", file));
  orient(file);
  tree_.fit(boxes_.data(), [&](int t, const auto& grow) {
    for (const int corner : triangles_[sandglass::at(t)]) grow(point(corner));
  });
  set_normals(file);
}

/// Turns normals to the outside.
void TriangleSurface::orient(const std::string& file) {
  double volume = 0.0, size = 0.0;
  for (const auto& [a, b, c] : triangles_) {
    const Vector &A = point(a), &B = point(b), &C = point(c);
    const Vector ab = difference(B, A), ac = difference(C, A), normal = cross(ab, ac);
    constexpr double least_area = 1e-12;  // of the square of its edges
    if (!(length(normal) > least_area * (dot(ab, ab) + dot(ac, ac)))) {
      throw InputError(
          fmt::format("{}: the triangle at {}, {}, {} m has no area, and so no normal; allowed: triangles "
                      "with an area",
                      file, text_of(A), text_of(B), text_of(C)));
    }
    volume += dot(difference(A, points_.front()), normal) / 6.0;
    size += length(normal) * length(difference(A, points_.front()));
  }
  if (!(std::abs(volume) > 1e-12 * size))
    throw InputError(fmt::format("{}: the surface encloses no volume; allowed: a closed surface", file));
  if (volume > 0.0) return;
  for (Triangle& corners : triangles_) std::swap(corners[1], corners[2]);
}

void TriangleSurface::set_normals(const std::string& file) {
  std::map<std::array<int, 2>, std::size_t> at_edge;
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    for (std::size_t I = 0; I < 3; ++I) {
      const int a = triangles_[t][I], b = triangles_[t][(I + 1) % 3];
      if (at_edge.try_emplace({a, b}, t).second) continue;
      throw InputError(fmt::format(
          "{}: at the edge from {} to {} m the surface branches, or its triangles have opposite "
          "orientations; allowed: two triangles at each edge, with their normals to the same side",
          file, text_of(point(a)), text_of(point(b))));
    }
  }
  normals_.resize(triangles_.size());
  NodalField of_points(points_.size());
  const auto corner = [&](std::size_t t, std::size_t I) { return point(triangles_[t][I % 3]); };
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    const Vector normal =
        cross(difference(corner(t, 1), corner(t, 0)), difference(corner(t, 2), corner(t, 0)));
    normals_[t][0] = direction_of(normal, length(normal));
    for (std::size_t I = 0; I < 3; ++I) {
      const Vector a = difference(corner(t, I + 1), corner(t, I)),
                   b = difference(corner(t, I + 2), corner(t, I));
      Vector& of_point = of_points[sandglass::at(triangles_[t][I])];
      of_point = sum(of_point, std::atan2(length(cross(a, b)), dot(a, b)), normals_[t][0]);
    }
  }
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    for (std::size_t I = 0; I < 3; ++I) {
      const int a = triangles_[t][I], b = triangles_[t][(I + 1) % 3];
      const auto other = at_edge.find({b, a});
      if (other == at_edge.end()) {
        throw InputError(
            fmt::format("{}: the surface is open at the edge from {} to {} m; allowed: a closed surface",
                        file, text_of(point(a)), text_of(point(b))));
      }
      normals_[t][1 + I] = sum(normals_[t][0], 1.0, normals_[other->second][0]);
      normals_[t][4 + I] = of_points[sandglass::at(a)];
    }
  }
}

void TriangleSurface::compare(const Vector& x, std::size_t triangle, Closest& closest) const {
  std::array<Vector, 3> X;
  for (std::size_t I = 0; I < 3; ++I) X[I] = point(triangles_[triangle][I]);
  const TriangleFoot foot = TriangleFoot::of(X, x);
  const Vector point = point_of(X, foot.weights), from = difference(x, point);
  const double square = dot(from, from);
  if (square < closest.square) closest = {square, point, normals_[triangle][foot.feature], foot.feature == 0};
}

double TriangleSurface::half_thickness() const {
  const Row<double>&low = boxes_[0], &high = boxes_[1];
  return 0.5 * std::min({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
}

Gap TriangleSurface::at(const Vector& x) const {
  Closest closest{INFINITY, {}, {}, false};
  tree_.search(x, boxes_.data(), closest.square, [&](int t) { compare(x, sandglass::at(t), closest); });
  const Vector from = difference(x, closest.point);
  // Close to a face, the direction from the closest point is rounding.
  if (closest.is_face) return {dot(from, closest.normal), closest.normal};
  const double r = std::sqrt(closest.square), side = dot(from, closest.normal) < 0.0 ? -1.0 : 1.0;
  if (r == 0.0) return {0.0, direction_of(closest.normal, length(closest.normal))};
  return {side * r, sum({}, side / r, from)};
}

TriangleSurface read_triangle_surface(const std::filesystem::path& path) {
  const std::string file = path.string(), ending = path.extension().string();
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw InputError(fmt::format("{}: cannot be read; allowed: an .stl or .obj file", file));
  const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  std::istringstream text(bytes);
  const auto read = [&] {
    if (ending == ".obj") return read_obj(text);
    if (ending != ".stl") throw InputError("unknown ending; allowed: .stl or .obj");
    std::uint32_t count = 0;
    if (bytes.size() >= 84) std::memcpy(&count, bytes.data() + 80, sizeof count);
    const bool binary = bytes.size() == 84 + 50 * static_cast<std::size_t>(count);
    return binary ? read_binary_stl(bytes) : read_text_stl(text);
  };
  try {
    Soup soup = read();
    return {std::move(soup.points), std::move(soup.triangles), file};
  } catch (const InputError& error) {
    const std::string said = error.what();
    throw InputError(said.starts_with(file) ? said : fmt::format("{}: {}", file, said));
  }
}

}  // namespace sandglass
