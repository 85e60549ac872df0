#include "app/bench_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "assembly/processor.hpp"

namespace sandglass {

namespace {

/// One column of figures.
struct Column {
  std::string head;
  std::string unit;
  std::function<std::string(const BenchRecord&, const Speed&)> text;
};

std::string ratio(const std::optional<double>& value) {
  return value ? fmt::format("{:.2f}", *value) : "-";
}

std::string or_dash(const std::optional<double>& value, double factor = 1.0) {
  return value ? fmt::format("{:.3g}", factor * *value) : "-";
}

std::string whole_percent(double share) {
  return fmt::format("{:.0f}", 100.0 * share);
}

const std::vector<Column>& columns() {
  using R = const BenchRecord&;
  using S = const Speed&;
  static const std::vector<Column> all{
      {"median", "ns/el/step", [](R, S s) { return fmt::format("{:.2f}", s.ns.median); }},
      {"q1", "ns", [](R, S s) { return fmt::format("{:.2f}", s.ns.lower_quartile); }},
      {"q3", "ns", [](R, S s) { return fmt::format("{:.2f}", s.ns.upper_quartile); }},
      {"best", "ns", [](R, S s) { return fmt::format("{:.2f}", s.ns.best); }},
      {"time over", "tl-pert.", [](R, S s) { return ratio(s.to_tl_perturbation); }},
      {"speed-up", "on scalar", [](R, S s) { return ratio(s.speedup); }},
      {"mean step", "ms", [](R r, S) { return or_dash(r.mean_step, 1e3); }},
      {"s per", "sim. s", [](R r, S) { return or_dash(r.per_simulated_second()); }},
      {"p50", "us/step", [](R, S s) { return fmt::format("{:.1f}", s.p50_us); }},
      {"p99", "us/step", [](R, S s) { return fmt::format("{:.1f}", s.p99_us); }},
      {"max", "us/step", [](R, S s) { return fmt::format("{:.1f}", s.max_us); }},
      {"counted", "flop", [](R r, S) { return fmt::format("{:.0f}", r.work.operations); }},
      {"moved", "bytes", [](R r, S) { return fmt::format("{:.0f}", r.work.bytes); }},
      {"speed", "Gflop/s", [](R, S s) { return fmt::format("{:.1f}", s.gflops); }},
      {"of peak", "%", [](R, S s) { return whole_percent(s.peak_share); }},
      {"traffic", "GB/s", [](R, S s) { return fmt::format("{:.1f}", s.gbs); }},
      {"of memory", "%", [](R, S s) { return whole_percent(s.memory_share); }},
      {"roofline", "%", [](R, S s) { return whole_percent(s.roofline_fraction); }}};
  return all;
}

/// The columns that name a variant, or their heads; `width` is the width of the method's column.
std::string label(std::string_view method, std::string_view kernel, std::string_view number,
                  const std::string& threads, std::size_t width) {
  return fmt::format("{:<{}}  {:<6}  {:<6}  {:>3}", method, width, kernel, number, threads);
}

/// The width of a table in characters; it leaves a margin in a terminal.
constexpr std::size_t most_width = 110;

/// Heads, units and a line for each record: its name, and as many columns of figures as fit.
class Block {
 public:
  Block(const std::vector<BenchRecord>& records, std::size_t longest)
      : heads_(label("", "", "", "", longest)), units_(label("method", "kernel", "number", "thr", longest)) {
    for (const auto& record : records) {
      const MethodChoice& choice = record.choice;
      lines_.push_back(label(choice.method, kernel_name(choice), name_of(choice.precision),
                             fmt::to_string(choice.threads), longest));
    }
    bare_ = heads_.size();
  }

  bool has_room(std::size_t width) const {
    return heads_.size() == bare_ || heads_.size() + 2 + width <= most_width;
  }

  void add(const Column& column, const std::vector<std::string>& cells, std::size_t width) {
    heads_ += fmt::format("  {:>{}}", column.head, width);
    units_ += fmt::format("  {:>{}}", column.unit, width);
    for (std::size_t n = 0; n < cells.size(); ++n) {
      if (!cells[n].empty()) lines_[n] += fmt::format("  {:>{}}", cells[n], width);
    }
  }

  /// Ends the lines of records without figures with the reason.
  std::string text(const std::vector<BenchRecord>& records) const {
    std::string text = heads_ + "\n" + units_ + "\n";
    for (std::size_t n = 0; n < records.size(); ++n) {
      text += lines_[n] + (records[n].speed ? "" : "  " + records[n].status) + "\n";
    }
    return text;
  }

 private:
  std::string heads_, units_;
  std::vector<std::string> lines_;
  std::size_t bare_;
};

}  // namespace

std::string bench_table(const std::vector<BenchRecord>& records) {
  const BenchRecord& first = records.front();
  std::size_t longest = 0;
  for (const auto& record : records) longest = std::max(longest, record.choice.method.size());
  std::string table =
      fmt::format("{}: {} elements, {} nodes\n", first.case_name, first.elements, first.nodes);
  Block block(records, longest);
  for (const auto& column : columns()) {
    std::size_t width = std::max(column.head.size(), column.unit.size());
    std::vector<std::string> cells;
    for (const auto& record : records) {
      cells.push_back(record.speed ? column.text(record, *record.speed) : "");
      width = std::max(width, cells.back().size());
    }
    if (!block.has_room(width)) {
      table += block.text(records);
      block = Block(records, longest);
    }
    block.add(column, cells, width);
  }
  return table + block.text(records);
}

std::string spread_warning(const std::vector<BenchRecord>& records) {
  const auto count = std::count_if(records.begin(), records.end(), is_disturbed);
  if (count == 0) return "";
  return fmt::format(
      "warning: q3 is more than {:g} times q1 in {} of {} rows: measure again when the machine is quiet\n",
      most_spread, count, records.size());
}

std::string rest_table(const Scene& scene, const std::vector<RestRecord>& records) {
  std::size_t longest = 0;
  for (const auto& record : records) longest = std::max(longest, record.choice.method.size());
  std::string table =
      fmt::format("{}: {} elements, {} nodes\n{:<{}}  {:<6}  {:>3}{:>11}{:>13}{:>19}{:>8}{:>10}\n",
                  scene.settings.name, scene.mesh.cells.size(), scene.mesh.points.size(), "method", longest,
                  "number", "thr", "to 1 %, s", "to 0.1 %, s", "to equilibrium, s", "evals", "residual");
  for (const auto& record : records) {
    const MethodChoice& choice = record.choice;
    table += fmt::format("{:<{}}  {:<6}  {:>3}", choice.method, longest, name_of(choice.precision),
                         choice.threads);
    table += record.times ? fmt::format("{:>11.3g}{:>13.3g}{:>19.3g}{:>8}{:>10.1e}\n",
                                        record.times->to_1_percent, record.times->to_0_1_percent,
                                        record.times->to_rest, record.evaluations, record.residual)
                          : fmt::format("  {}\n", record.status);
  }
  return table;
}

std::string side_by_side_table(const std::vector<SideBySide>& records) {
  std::string table = fmt::format(
      "{}: {} bodies of {} elements, ns per element and step, median and quartiles\n"
      "{:<20}{:<8}{:>4}{:>26}{:>26}{:>8}\n",
      records.front().case_name, records.front().bodies, records.front().elements, "method", "number", "thr",
      "one by one", "side by side", "ratio");
  const auto text = [](const Spread& ns) {
    return fmt::format("{:.2f} ({:.2f} to {:.2f})", ns.median, ns.lower_quartile, ns.upper_quartile);
  };
  for (const auto& record : records) {
    table += fmt::format("{:<20}{:<8}{:>4}", record.choice.method, name_of(record.choice.precision),
                         record.choice.threads);
    table += record.status == "ok" ? fmt::format("{:>26}{:>26}{:>8.2f}\n", text(record.one_by_one),
                                                 text(record.batch), record.ratio)
                                   : fmt::format("  {}\n", record.status);
  }
  return table;
}

std::string machine_lines(const BenchPlan& plan, MachineSpeed& machine) {
  std::string lines;
  for (const int threads : plan.threads) {
    lines += fmt::format(
        "{} thread{}: peak {:.1f} Gflop/s in double, {:.1f} in float; memory {:.1f} GB/s{}\n", threads,
        threads == 1 ? "" : "s", machine.peak_gflops(Precision::double_precision, threads),
        machine.peak_gflops(Precision::single_precision, threads), machine.memory_gbs(threads),
        threads > available_processors() ? "; more threads than processors" : "");
  }
  if (plan.processor != nullptr) lines += fmt::format("device: {}\n", plan.processor->name());
  return lines;
}

}  // namespace sandglass
