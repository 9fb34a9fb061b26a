// The commands of the waverig program, one file each. A registration adds a subcommand to the parser;
// its callback stores what to run, and main() runs it and turns errors into exit statuses.
#pragma once
#include <functional>

namespace CLI {
class App;
}

namespace waverig::cli {

using Command = std::function<int()>;  // returns the exit status: 0 done, 1 the answer is no

void add_sweep(CLI::App& app, Command& chosen);
void add_plan(CLI::App& app, Command& chosen);
void add_estimate(CLI::App& app, Command& chosen);
void add_evaluate(CLI::App& app, Command& chosen);
void add_figures(CLI::App& app, Command& chosen);
void add_report(CLI::App& app, Command& chosen);
void add_film(CLI::App& app, Command& chosen);
void add_merge(CLI::App& app, Command& chosen);
void add_compare(CLI::App& app, Command& chosen);
void add_calibrate(CLI::App& app, Command& chosen);
void add_calibrate_front_end(CLI::App& calibrate, Command& chosen);  // a command of calibrate
void add_calibrations(CLI::App& app, Command& chosen);
void add_bench(CLI::App& app, Command& chosen);
void add_bench_estimators(CLI::App& app, Command& chosen);
void add_analyse(CLI::App& app, Command& chosen);
void add_node(CLI::App& app, Command& chosen);

inline constexpr void (*kCommands[])(CLI::App&, Command&) = {
    add_sweep,   add_plan,  add_estimate,         add_evaluate,  add_figures,
    add_report,  add_film,  add_compare,          add_merge,     add_node,
    add_analyse, add_bench, add_bench_estimators, add_calibrate, add_calibrations};

}  // namespace waverig::cli
