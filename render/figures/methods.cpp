#include "render/figures/methods.h"

#include <cmath>
#include <type_traits>
#include <variant>

namespace waverig::render {
namespace {

bool same(const std::vector<double>& a, const std::vector<double>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](double p, double q) { return p == q || (std::isnan(p) && std::isnan(q)); });
}

bool same_series(const Mark& a, const Mark& b) {
  return std::visit(
      [&](const auto& m) {
        using M = std::decay_t<decltype(m)>;
        const auto* n = std::get_if<M>(&b);
        if constexpr (std::is_same_v<M, Line> || std::is_same_v<M, Points>)
          return n != nullptr && same(m.x, n->x) && same(m.y, n->y);
        else if constexpr (std::is_same_v<M, ErrorBars>)
          return n != nullptr && same(m.x, n->x) && same(m.y, n->y) && same(m.minus, n->minus) &&
                 same(m.plus, n->plus);
        else
          return false;
      },
      a);
}

std::string* name_in(Mark& mark) {
  if (auto* line = std::get_if<Line>(&mark)) return &line->name;
  if (auto* points = std::get_if<Points>(&mark)) return &points->name;
  return nullptr;
}

}  // namespace

void draw_same_once(std::vector<Mark>& marks) {
  std::vector<Mark> kept;
  for (Mark& mark : marks) {
    const auto twin = std::ranges::find_if(kept, [&](const Mark& m) { return same_series(m, mark); });
    if (twin == kept.end()) {
      kept.push_back(std::move(mark));
      continue;
    }
    const std::string* other = name_in(mark);
    if (std::string* name = name_in(*twin); name != nullptr && other != nullptr && !other->empty())
      *name += (name->empty() ? "" : ", ") + *other;
  }
  marks = std::move(kept);
}

}  // namespace waverig::render
