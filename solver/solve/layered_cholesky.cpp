#include "solve/layered_cholesky.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>

#include "base/error.hpp"

namespace sandglass {

namespace {

using Block = Eigen::Map<Eigen::MatrixXd>;
using ConstBlock = Eigen::Map<const Eigen::MatrixXd>;

}  // namespace

std::vector<std::vector<int>> layers_from(const std::vector<int>& first,
                                          const std::vector<std::vector<int>>& neighbours) {
  std::vector<bool> met(neighbours.size(), false);
  std::vector<std::vector<int>> layers;
  const auto spread = [&](std::vector<int> layer) {
    for (const int vertex : layer) met[static_cast<std::size_t>(vertex)] = true;
    while (!layer.empty()) {
      std::vector<int> next;
      for (const int vertex : layer) {
        for (const int neighbour : neighbours[static_cast<std::size_t>(vertex)]) {
          if (met[static_cast<std::size_t>(neighbour)]) continue;
          met[static_cast<std::size_t>(neighbour)] = true;
          next.push_back(neighbour);
        }
      }
      layers.push_back(std::move(layer));
      layer = std::move(next);
    }
  };
  spread(first);
  for (std::size_t vertex = 0; vertex < met.size(); ++vertex) {
    if (!met[vertex]) spread({static_cast<int>(vertex)});
  }
  return layers;
}

LayeredCholesky::LayeredCholesky(const std::vector<int>& sizes) {
  int first = 0, before = 0;
  for (const int size : sizes) {
    const auto rows = static_cast<std::size_t>(size), columns = static_cast<std::size_t>(before);
    layer_of_row_.insert(layer_of_row_.end(), rows, static_cast<int>(layers_.size()));
    layers_.push_back({first, size, std::vector<double>(rows * rows), std::vector<double>(rows * columns)});
    first += size;
    before = size;
  }
}

void LayeredCholesky::add(int row, int column, double value) {
  if (row < column) return;
  Layer& layer = layers_[static_cast<std::size_t>(layer_of_row_[static_cast<std::size_t>(row)])];
  const auto at = [&](int first) {
    return static_cast<std::size_t>(column - first) * static_cast<std::size_t>(layer.size) +
           static_cast<std::size_t>(row - layer.first);
  };
  if (column >= layer.first) {
    layer.diagonal[at(layer.first)] += value;
  } else {
    layer.below[at((&layer - 1)->first)] += value;
  }
}

void LayeredCholesky::factorise() {
  for (std::size_t k = 0; k < layers_.size(); ++k) {
    Layer& layer = layers_[k];
    if (layer.size == 0) continue;
    Block D(layer.diagonal.data(), layer.size, layer.size);
    const double largest = D.diagonal().maxCoeff();
    if (k > 0 && layers_[k - 1].size > 0) {
      const Layer& before = layers_[k - 1];
      const ConstBlock L(before.diagonal.data(), before.size, before.size);
      Block E(layer.below.data(), layer.size, before.size);
      L.transpose().triangularView<Eigen::Upper>().solveInPlace<Eigen::OnTheRight>(E);
      D.selfadjointView<Eigen::Lower>().rankUpdate(E, -1.0);
    }
    Eigen::Ref<Eigen::MatrixXd> in_place(D);
    const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> factor(in_place);
    // A pivot of the size of roundoff counts as zero.
    if (factor.info() != Eigen::Success || D.diagonal().array().square().minCoeff() < 1e-13 * largest) {
      throw ComputationError(fmt::format(
          "the stiffness is not positive definite (layer {} of {}): a part of the body is free to move; "
          "remedy: impose displacements that hold every part, and a kappa above 0",
          k, layers_.size()));
    }
  }
}

void LayeredCholesky::solve(std::span<double> b) const {
  const auto part = [&](const Layer& layer) {
    return Eigen::Map<Eigen::VectorXd>(b.data() + layer.first, layer.size);
  };
  for (std::size_t k = 0; k < layers_.size(); ++k) {
    const Layer& layer = layers_[k];
    auto y = part(layer);
    if (k > 0) y -= ConstBlock(layer.below.data(), layer.size, layers_[k - 1].size) * part(layers_[k - 1]);
    ConstBlock(layer.diagonal.data(), layer.size, layer.size).triangularView<Eigen::Lower>().solveInPlace(y);
  }
  for (std::size_t k = layers_.size(); k-- > 0;) {
    const Layer& layer = layers_[k];
    auto x = part(layer);
    if (k + 1 < layers_.size()) {
      const Layer& next = layers_[k + 1];
      x -= ConstBlock(next.below.data(), next.size, layer.size).transpose() * part(next);
    }
    ConstBlock(layer.diagonal.data(), layer.size, layer.size)
        .transpose()
        .triangularView<Eigen::Upper>()
        .solveInPlace(x);
  }
}

}  // namespace sandglass
