// Someone else's program: it knows LCM and the message types, nothing of waverig. Its "method" hears the
// truth, which no honest one does, so that a test knows what must come out: a heave that is too large by a
// known gain.
//   outsider BUS GAIN
#include <cstdlib>
#include <lcm/lcm-cpp.hpp>
#include <string>
#include <waverig/heave_t.hpp>
#include <waverig/truth_t.hpp>

namespace {

class Outsider {
 public:
  Outsider(lcm::LCM& lcm, double gain) : lcm_(lcm), gain_(gain) {
    lcm_.subscribe("WAVERIG_TRUTH", &Outsider::hear, this)->setQueueCapacity(0);
  }

 private:
  void hear(const lcm::ReceiveBuffer*, const std::string&, const waverig::truth_t* truth) {
    waverig::heave_t heave{};
    heave.utime = truth->utime;
    heave.seq = truth->seq;
    heave.heave_m = gain_ * truth->heave_m;
    heave.heave_rate_mps = gain_ * truth->heave_rate_mps;
    heave.heave_sigma_m = 0.01;
    heave.quat_NB[0] = 1;
    lcm_.publish("WAVERIG_HEAVE_outsider", &heave);
  }

  lcm::LCM& lcm_;
  double gain_;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  lcm::LCM lcm(argv[1]);
  if (!lcm.good()) return 2;
  Outsider outsider(lcm, std::atof(argv[2]));
  while (lcm.handle() == 0) continue;
  return 1;
}
