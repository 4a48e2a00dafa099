#include "engine/solvers/direct/elimination_order.h"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>

#include "engine/solvers/direct/direct_fronts.h"

namespace weft {
namespace {

std::vector<std::uint32_t> least_fill(const Lists& neighbours) {
  using Matrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;
  std::vector<Eigen::Triplet<double, int>> entries;
  const auto size = static_cast<int>(neighbours.size());
  for (int k = 0; k < size; ++k) {
    entries.emplace_back(k, k, 1.0);
    for (const std::uint32_t j : neighbours[static_cast<std::size_t>(k)]) {
      entries.emplace_back(k, static_cast<int>(j), 1.0);
    }
  }
  Matrix matrix(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> permutation;
  Eigen::AMDOrdering<int>()(matrix, permutation);
  std::vector<std::uint32_t> order;
  for (int i = 0; i < size; ++i)
    order.push_back(static_cast<std::uint32_t>(permutation.indices()[i]));
  return order;
}

}  // namespace

std::vector<std::uint32_t> elimination_order(const Lists& neighbours) {
  const std::vector<std::uint32_t> filling = least_fill(neighbours);
  std::vector<std::uint32_t> order;
  for (const std::uint32_t k : postorder(elimination_tree(in_order(neighbours, filling))))
    order.push_back(filling[k]);
  return order;
}

Lists in_order(const Lists& neighbours, const std::vector<std::uint32_t>& order) {
  std::vector<std::uint32_t> place(order.size()), list;
  for (std::uint32_t i = 0; i < order.size(); ++i) place[order[i]] = i;
  Lists lists;
  for (const std::uint32_t k : order) {
    list.clear();
    for (const std::uint32_t j : neighbours[k]) list.push_back(place[j]);
    lists.push_back(list);
  }
  return lists;
}

}  // namespace weft
