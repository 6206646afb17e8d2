#include <algorithm>

#include "tendril/rod/rod.hpp"

namespace tendril::rod {

Eigen::Vector3d LoadField::at(double place, Eigen::Vector3d* slope) const {
  if (slope) slope->setZero();
  if (none()) return Eigen::Vector3d::Zero();
  if (place < S.front()) return value.front();
  if (place >= S.back()) return value.back();
  const std::size_t i = std::upper_bound(S.begin(), S.end(), place) - S.begin() - 1;
  const Eigen::Vector3d rate = (value[i + 1] - value[i]) / (S[i + 1] - S[i]);
  if (slope) *slope = rate;
  return value[i] + (place - S[i]) * rate;
}

}  // namespace tendril::rod
