#include "estimator/heave/sea_identifier.h"

#include <cmath>

namespace waverig::estimator {
namespace {

constexpr double kDt = kNodeInterval_s;
constexpr std::size_t kShortest = 48;  // nodes before the first periodogram: 24 s
constexpr double kLeastSea = 1e-4;     // of the unknown sea: what a calm may still become

}  // namespace

SeaIdentifier::SeaIdentifier(const SeaIdentifierSettings& settings)
    : settings_(settings),
      periodogram_(settings.block),
      until_next_(settings.every),
      density_(Eigen::VectorXd::Zero(settings.block / 2 + 1)),
      model_(unknown_sea(settings.order, settings.accel_noise_m2ps3)) {
  newest_.reserve(static_cast<std::size_t>(2 * settings.block));
}

void SeaIdentifier::gap() {
  has_last_ = false;
  newest_.clear();
}

bool SeaIdentifier::add(const PathIncrement& increment) {
  if (has_last_) newest_.push_back(second_difference_m(last_, increment, kDt));
  last_ = increment;
  has_last_ = true;
  if (--until_next_ > 0 || newest_.size() < kShortest) return false;
  until_next_ = settings_.every;
  const auto block = static_cast<std::ptrdiff_t>(settings_.block);
  if (std::ssize(newest_) > block) newest_.erase(newest_.begin(), newest_.end() - block);
  periodogram();
  identify();
  return true;
}

void SeaIdentifier::periodogram() {
  // A short first block is coarse and counts for little once longer ones come.
  const double fresh = std::pow(static_cast<double>(newest_.size()) / settings_.block, 3);
  const double kept = settings_.memory_s > 0 ? std::exp(-settings_.every * kDt / settings_.memory_s) : 1;
  weight_ = kept * weight_ + fresh;
  density_ += fresh / weight_ * (periodogram_.of(newest_, kDt) - density_);
}

void SeaIdentifier::identify() {
  const SeaAndNoise split = split_sea_from_noise(density_, kDt, settings_.accel_noise_m2ps3);
  model_ = model_of_density(split.heave_density_m2s, 1 / (kDt * settings_.block), settings_.order);
  if (model_.heave_variance_m2() < kLeastSea * kUnknownSea_m2) {  // calm: whatever comes, comes from anywhere
    model_ = unknown_sea(settings_.order, split.noise_m2ps3);
    model_.autocovariance_m2 *= kLeastSea;
    model_.innovation_m2 *= kLeastSea;
  }
  model_.set_noise(split.noise_m2ps3);
}

}  // namespace waverig::estimator
