#include "estimator/heave/sea_identifier.h"

#include <algorithm>
#include <cmath>

#include "estimator/types.h"

namespace waverig::estimator {
namespace {

constexpr double kDt = kFineInterval_s;
constexpr int kFirstGuess = 1;         // nodes before the first guess
constexpr int kShortest = 56;          // nodes before the first periodogram: 14 s
constexpr int kGuesses = 12;           // a guess is made again when a twelfth more is seen
constexpr int kGuessed = 80;           // nodes for which the guess is better than any periodogram: 20 s
constexpr int kKept = 16;              // of the old sea's nodes, which saw the new one begin
constexpr double kResolved = 2.5;      // cycles a block: what a Hann window keeps apart from the mean
constexpr double kUnlike = 0.6;        // divergence from which on a guess tells little
constexpr double kSwellEnd_hz = 0.21;  // the short waves of a sea far away do not get here
constexpr double kLeastShare = 1e-9;   // of a sea in one bin
constexpr double kFirstRidge = 3e-6;   // of a sea's variance, as model_of_density has it
constexpr double kRidge = 1e-7;        // of a sea well known
constexpr double kShortRecord = 0.01;  // weight of its periodograms
constexpr double kYoung = 0.2;         // of a grown sea's slow waves, in one that just came up
constexpr double kLeastSea = 1e-4;     // of the unknown sea: what a calm may still become
constexpr double kCalm = 1e-3;         // of the unknown sea: a calm
constexpr double kSlowSea = 0.1;       // of the unknown sea's slow waves: one that comes up unseen

// Kullback, Leibler 1951: how unlike the guess the shape of what is seen is. Of periodograms of a sea of that
// very shape 0.2 to 0.4, of a single wave 1 to 4.
double divergence(const Eigen::VectorXd& seen, const Eigen::VectorXd& guess) {
  const double seen_sum = seen.sum(), guess_sum = guess.sum();
  double sum = 0;
  for (Eigen::Index i = 0; i < seen.size(); ++i)
    if (seen[i] > 0) {
      const double p = seen[i] / seen_sum, q = std::max(guess[i] / guess_sum, kLeastShare);
      sum += p * std::log(p / q);
    }
  return sum;
}

}  // namespace

SeaIdentifier::SeaIdentifier(const SeaIdentifierSettings& settings)
    : settings_(settings),
      periodogram_(settings.block),
      guess_(kDt, settings.block / 2 + 1, settings.accel_noise_m2ps3, settings.offset_sigma_mps2),
      until_next_(kFirstGuess),
      density_(Eigen::VectorXd::Zero(settings.block / 2 + 1)),
      model_(unknown_sea(settings.interval_s > 0 ? settings.interval_s : 2 * kFineInterval_s, settings.order,
                         settings.accel_noise_m2ps3)) {
  unknown_ = unknown_sea_density_m2s(density_.size(), 1 / (kDt * settings.block));
  newest_.reserve(static_cast<std::size_t>(2 * settings.block));
}

void SeaIdentifier::restart() {
  model_ = unknown_sea(model_.interval_s, settings_.order, settings_.accel_noise_m2ps3);
  gap();
  guess_.restart();
  guesses_ = true;
  came_up_ = false;
  weight_ = 0;
  age_ = 0;
  until_next_ = kFirstGuess;
}

void SeaIdentifier::gap() {
  has_last_ = false;
  newest_.clear();
  guess_.gap();
}

void SeaIdentifier::forget(bool out_of_calm) {
  if (std::ssize(newest_) > kKept) newest_.erase(newest_.begin(), newest_.end() - kKept);
  guesses_ = out_of_calm;
  came_up_ = true;
  guess_.restart();
  weight_ = 0;
  age_ = 0;
  until_next_ = guesses_ ? kFirstGuess : kShortest - kKept;
}

bool SeaIdentifier::add(const PathIncrement& increment) {
  if (has_last_) {
    newest_.push_back(second_difference_m(last_, increment, kDt));
    if (guesses_) guess_.add(newest_.back());
  }
  last_ = increment;
  has_last_ = true;
  ++age_;
  const bool guessing = guesses_ && !has_spectrum();
  if (--until_next_ > 0 || std::ssize(newest_) < (guessing ? kFirstGuess : kShortest)) return false;
  const auto block = static_cast<std::ptrdiff_t>(settings_.block);
  if (std::ssize(newest_) > block) newest_.erase(newest_.begin(), newest_.end() - block);
  const auto n = static_cast<int>(newest_.size());
  const bool guess_alone = guessing && n < kGuessed;
  if (!guess_alone) periodogram();
  // Where there is a guess, periodograms that overlap by more tell it little.
  until_next_ = guess_alone ? std::max(n / kGuesses, 1) : std::min(n / (guesses_ ? 2 : 4), settings_.every);
  return true;
}

void SeaIdentifier::periodogram() {
  // A short first block is coarse and counts for little once longer ones come.
  const double fresh = std::pow(static_cast<double>(newest_.size()) / settings_.block, 3);
  const double kept = settings_.memory_s > 0 ? std::exp(-settings_.every * kDt / settings_.memory_s) : 1;
  weight_ = kept * weight_ + fresh;
  density_ += fresh / weight_ * (periodogram_.of(newest_, kDt) - density_);
  lowest_hz_ = kResolved / (kDt * static_cast<double>(newest_.size()));
}

bool SeaIdentifier::calm() const { return model_.heave_variance_m2() < kCalm * kUnknownSea_m2; }

SeaModel SeaIdentifier::slow_sea() const {
  const double df = 1 / (kDt * settings_.block);
  const auto end = std::lround(kSwellEnd_hz / df);
  Eigen::VectorXd sea = kLeastSea * unknown_;
  sea.head(end) += kSlowSea * unknown_.head(end);
  SeaModel model = model_of_density(sea, df, model_.interval_s, settings_.order, kFirstRidge);
  model.set_noise(settings_.accel_noise_m2ps3);
  return model;
}

const SeaModel& SeaIdentifier::identify(double swell) {
  const double df = 1 / (kDt * settings_.block);
  const SeaGuess::Guess first = guesses_ ? guess_.guess() : SeaGuess::Guess{unknown_, 1};
  doubt_ = weight_ > 0 ? 1 : first.doubt;
  SeaAndNoise split{first.density_m2s, settings_.accel_noise_m2ps3, 1};
  Eigen::VectorXd& sea = split.heave_density_m2s;
  if (guesses_) {
    const auto end = std::lround(kSwellEnd_hz / df);
    sea.head(end) += swell * sea.sum() / unknown_.head(end).sum() * unknown_.head(end);
  }
  if (weight_ > 0) {
    const Eigen::VectorXd guess = sea;
    split = split_sea_from_noise(density_, kDt, settings_.accel_noise_m2ps3, lowest_hz_);
    // What is too slow to be resolved yet is as guessed; in a sea that came up and has not grown its longest
    // waves yet, in proportion to the rest.
    const auto slow = static_cast<Eigen::Index>(lowest_hz_ / df) + 1, fast = sea.size() - slow;
    if (came_up_)
      sea.head(slow) = kYoung * sea.tail(fast).sum() / unknown_.tail(fast).sum() * unknown_.head(slow);
    else
      sea.head(slow) = guess.head(slow);
    if (guesses_) {
      const double guessed =
          settings_.guess_weight * std::exp(-square(divergence(sea.tail(fast), guess.tail(fast)) / kUnlike));
      sea.tail(fast) += guessed / (guessed + weight_) * (guess.tail(fast) - sea.tail(fast));
    }
  }
  const double interval_s =
      settings_.interval_s > 0 ? settings_.interval_s : suited_interval_s(sea, df, model_.interval_s);
  // Few periodograms have not shown yet what there is not.
  const double ridge = weight_ > 0 ? std::max(kFirstRidge / (1 + weight_ / kShortRecord), kRidge) : kRidge;
  model_ = model_of_density(sea, df, interval_s, settings_.order, ridge);
  if (model_.heave_variance_m2() < kLeastSea * kUnknownSea_m2) {  // calm: whatever comes, comes from anywhere
    model_ = unknown_sea(model_.interval_s, settings_.order, split.noise_m2ps3);
    model_.autocovariance_m2 *= kLeastSea;
    model_.innovation_m2 *= kLeastSea;
  }
  model_.set_noise(split.noise_m2ps3);
  return model_;
}

}  // namespace waverig::estimator
