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

struct Outsider {
  lcm::LCM lcm;
  double gain;
};

void hear(const lcm::ReceiveBuffer*, const std::string&, const waverig::truth_t* truth, Outsider* self) {
  waverig::heave_t heave{};
  heave.utime = truth->utime;
  heave.seq = truth->seq;
  heave.heave_m = self->gain * truth->heave_m;
  heave.heave_rate_mps = self->gain * truth->heave_rate_mps;
  heave.heave_sigma_m = 0.01;
  heave.quat_NB[0] = 1;
  self->lcm.publish("WAVERIG_HEAVE_outsider", &heave);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  Outsider outsider{lcm::LCM(argv[1]), std::atof(argv[2])};
  if (!outsider.lcm.good()) return 2;
  // A function, not a member: gcc's sanitizer takes LCM's call through a pointer to a member for one on null.
  outsider.lcm.subscribeFunction("WAVERIG_TRUTH", &hear, &outsider)->setQueueCapacity(0);
  while (outsider.lcm.handle() == 0) continue;
  return 1;
}
