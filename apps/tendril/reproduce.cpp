#include "reproduce.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <mutex>
#include <thread>

#include "console.hpp"
#include "gallery.hpp"
#include "tendril/io/atomic_file.hpp"
#include "tendril/io/diagnostics.hpp"

namespace tendril::app {
namespace {

using reproduce::System;

std::size_t columns_of(std::string_view text) {  // UTF-8 characters
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

std::string padded(const std::string& text, std::size_t width) {
  return text + std::string(width - std::min(width, columns_of(text)), ' ');
}

int list_systems() {
  std::size_t name = 4, section = 6;
  for (const System& s : reproduce::systems()) {
    name = std::max(name, columns_of(s.name));
    section = std::max(section, columns_of(s.section));
  }
  std::string out = padded("name", name) + "  " + padded("thesis", section) + "  title\n";
  for (const System& s : reproduce::systems()) {
    out += padded(s.name, name) + "  " + padded(s.section, section) + "  " + s.title + "\n";
  }
  print(out + "\n`tendril reproduce NAME -o DIR` computes one, `tendril reproduce all -o DIR` all of them\n");
  return kSolved;
}

std::string describe(const Computed& c) {
  std::string out = c.system->title + " (thesis " + c.system->section + ")\n";
  if (!c.finished) return out + "  " + verdict(c) + "\n";
  std::size_t width = 8;
  for (const reproduce::Row& row : c.outcome.rows) width = std::max(width, columns_of(row.quantity));
  out += fmt::format("  {}  {:>18}  {:>18}  {:>11}  {:>9}  source\n", padded("quantity", width), "computed", "expected",
                     "difference", "tolerance");
  for (const reproduce::Row& row : c.outcome.rows) {
    out += fmt::format("  {}  {:>18.10g}  {:>18.10g}  {:>11.2e}  {:>9.1e}  {}{}\n", padded(row.quantity, width),
                       row.computed, row.expected, row.computed - row.expected, row.tolerance, row.source,
                       holds(row) ? "" : "  FAILED");
  }
  for (const std::string& note : c.outcome.notes) out += "  note: " + note + "\n";
  return out + fmt::format("{}: {}, largest difference {:.2g} of its tolerance\n", c.system->name, verdict(c),
                           worst_share(c));
}

std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

std::string number(double value) { return std::isfinite(value) ? io::shortest(value) : std::string(); }

std::string csv(const reproduce::Data& data) {
  std::string out;
  for (std::size_t i = 0; i < data.columns.size(); ++i) out += (i == 0 ? "" : ",") + csv_cell(data.columns[i]);
  out += "\n";
  std::size_t rows = 0;
  for (const auto& column : data.value) rows = std::max(rows, column.size());
  for (std::size_t r = 0; r < rows; ++r) {
    for (std::size_t i = 0; i < data.value.size(); ++i) {
      out += i == 0 ? "" : ",";
      if (r < data.value[i].size()) out += number(data.value[i][r]);
    }
    out += "\n";
  }
  return out;
}

std::string table_csv(const reproduce::Outcome& outcome) {
  std::string out = "quantity,computed,expected,difference,tolerance,holds,source\n";
  for (const reproduce::Row& row : outcome.rows) {
    out += csv_cell(row.quantity) + "," + number(row.computed) + "," + number(row.expected) + "," +
           number(row.computed - row.expected) + "," + number(row.tolerance) + "," + (holds(row) ? "yes" : "no") + "," +
           csv_cell(row.source) + "\n";
  }
  return out;
}

void write_outcome(const reproduce::Outcome& outcome, const std::string& directory) {
  io::make_directory(directory);
  for (const reproduce::Data& data : outcome.data) io::write_file(directory + "/" + data.name + ".csv", csv(data));
  for (const reproduce::Picture& picture : outcome.pictures) {
    io::write_file(directory + "/" + picture.name + ".svg",
                   "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n" + drawing::render_svg(picture.figure));
  }
  io::write_file(directory + "/table.csv", table_csv(outcome));
}

// Systems computed by a few threads; each writes its files as soon as it is done, so an interruption loses little.
class Work {
 public:
  Work(std::vector<const System*> list, const ReproduceOptions& options, Progress& bar)
      : options_(options), bar_(bar), several_(options.name == "all"), fraction_(list.size(), 0.0) {
    for (const System* s : list) {
      Computed c;
      c.system = s;
      computed.push_back(std::move(c));
    }
  }

  void run() {
    // The costly ones first, so that no thread is left alone with one at the end.
    for (std::size_t i = 0; i < computed.size(); ++i) order_.push_back(i);
    std::stable_sort(order_.begin(), order_.end(),
                     [&](std::size_t a, std::size_t b) { return computed[a].system->cost > computed[b].system->cost; });
    const std::size_t threads = std::min<std::size_t>(2, computed.size());
    std::vector<std::jthread> pool;
    for (std::size_t i = 1; i < threads; ++i) pool.emplace_back([this] { take_all(); });
    take_all();
    for (std::jthread& thread : pool) thread.join();
    if (file_error_) std::rethrow_exception(file_error_);
  }

  std::vector<Computed> computed;

 private:
  void take_all() {
    while (true) {
      std::size_t i = 0;
      {
        const std::lock_guard lock(mutex_);
        if (next_ == order_.size() || interrupted() || file_error_) return;
        i = order_[next_++];
      }
      compute(computed[i], i);
    }
  }

  void compute(Computed& c, std::size_t i) {
    try {
      c.outcome = c.system->compute([&](double fraction, const std::string& what) {
        const std::lock_guard lock(mutex_);
        fraction_[i] = std::isfinite(fraction) ? std::clamp(fraction, 0.0, 1.0) : 0.0;
        bar_.update(total(), several_ ? c.system->name + ": " + what : what);
        return !interrupted();
      });
      c.finished = true;
    } catch (const reproduce::Interrupted&) {
      c.failure = "interrupted";
    } catch (const std::exception& error) {
      c.failure = error.what();
    }
    const std::lock_guard lock(mutex_);
    try {
      if (c.finished && !options_.out.empty()) {
        write_outcome(c.outcome, several_ ? options_.out + "/" + c.system->name : options_.out);
      }
    } catch (const io::FileError&) {
      file_error_ = std::current_exception();
    }
    fraction_[i] = 1.0;
    ++done_;
    bar_.update(total(), c.system->name + " done");
    if (several_ && !options_.quiet && !is_terminal(stderr)) {
      message(fmt::format("{} of {}: {}: {}\n", done_, computed.size(), c.system->name, verdict(c)));
    }
  }

  double total() const {
    double done = 0, all = 0;
    for (std::size_t i = 0; i < computed.size(); ++i) {
      done += computed[i].system->cost * fraction_[i];
      all += computed[i].system->cost;
    }
    return all > 0 ? done / all : 1.0;
  }

  const ReproduceOptions& options_;
  Progress& bar_;
  const bool several_;
  std::mutex mutex_;
  std::vector<double> fraction_;  // done, of each system
  std::vector<std::size_t> order_;
  std::size_t next_ = 0, done_ = 0;
  std::exception_ptr file_error_;
};

std::string summary(const std::vector<Computed>& systems) {
  std::size_t name = 6;
  for (const Computed& c : systems) name = std::max(name, columns_of(c.system->name));
  std::string out = fmt::format("{}  {:>24}  verdict\n", padded("system", name), "difference / tolerance");
  std::size_t rows = 0, good = 0;
  for (const Computed& c : systems) {
    out += fmt::format("{}  {:>24}  {}\n", padded(c.system->name, name),
                       c.finished ? fmt::format("{:.2g}", worst_share(c)) : std::string("-"), verdict(c));
    rows += c.outcome.rows.size();
    good += static_cast<std::size_t>(std::count_if(c.outcome.rows.begin(), c.outcome.rows.end(),
                                                   [](const reproduce::Row& row) { return holds(row); }));
  }
  const auto whole = std::count_if(systems.begin(), systems.end(), [](const Computed& c) { return holds(c); });
  return out + fmt::format("{} of {} systems hold; {} of {} rows\n", whole, systems.size(), good, rows);
}

}  // namespace

int reproduce(const ReproduceOptions& options) {
  if (options.name.empty() && !options.out.empty()) {
    message("tendril: which system is written to `" + options.out +
            "`?\n       `tendril reproduce NAME -o DIR`, or `all`; without -o the names are listed\n");
    return kUsage;
  }
  if (options.name.empty()) return list_systems();
  const bool all = options.name == "all";
  std::vector<const System*> chosen;
  std::vector<std::string> names = {"all"};
  for (const System& s : reproduce::systems()) {
    names.push_back(s.name);
    if (all || s.name == options.name) chosen.push_back(&s);
  }
  if (chosen.empty() && !all) {
    const std::string near = io::nearest(options.name, names);
    message("tendril: there is no system `" + options.name + "`" +
            (near.empty() ? "" : "; did you mean `" + near + "`?") + "\n       `tendril reproduce` lists them\n");
    return kUsage;
  }
  if (!options.out.empty()) io::make_directory(options.out);  // fail before the work, not after it

  catch_interrupts();
  std::vector<Computed> computed;
  {
    Progress bar(!options.quiet);
    Work work(chosen, options, bar);
    work.run();
    computed = std::move(work.computed);
  }
  std::string text;
  for (const Computed& c : computed) text += describe(c) + (all ? "\n" : "");
  if (all) text += summary(computed);
  print(text);
  if (!options.out.empty()) {
    io::write_file(options.out + "/index.html", gallery_page(computed, all));
    if (!options.quiet) message("wrote " + options.out + "/index.html\n");
  } else if (!options.quiet && !interrupted()) {
    message("`-o DIR` keeps the data, the pictures and a page\n");
  }
  if (interrupted()) {
    message("interrupted: what was computed until then is kept\n");
    return kInterrupted;
  }
  const bool good = std::all_of(computed.begin(), computed.end(), [](const Computed& c) { return holds(c); });
  return good && !computed.empty() ? kSolved : kNotConverged;
}

}  // namespace tendril::app
