#pragma once
// The systems of the thesis, each computed anew on demand: a table computed | expected | difference, data, pictures.
// Plain data in, plain data out; files and pages are the faces' business.

#include <functional>
#include <string>
#include <vector>

#include "tendril/drawing/figure.hpp"

namespace tendril::reproduce {

/// One line of the table. It holds when |computed - expected| <= tolerance.
struct Row {
  std::string quantity;  // what, where, in which units
  double computed = 0.0, expected = 0.0;
  double tolerance = 0.0;  // rounding, printed digits or the accuracy asked of the solver; `source` says which
  std::string source;      // where the expected number comes from: "(II.3.16)", "closed form", "Lagrangian twin"
};

/// One CSV file.
struct Data {
  std::string name;                        // file name without extension
  std::vector<std::string> columns;        // with units: "F3 [B/L^2]"
  std::vector<std::vector<double>> value;  // one vector per column, of equal length
};

struct Picture {
  std::string name;  // file name without extension
  std::string caption;
  drawing::Figure figure;
};

struct Outcome {
  std::vector<Row> rows;
  std::vector<Data> data;
  std::vector<Picture> pictures;
  std::vector<std::string> notes;  // what the reader should know: which solution where there are several, limits met
};

/// Called now and then with the fraction done and what is being computed; false asks to stop (throw Interrupted).
using Progress = std::function<bool(double fraction, const std::string& what)>;
struct Interrupted {};

struct System {
  std::string name;     // for the command line: "helical_conduit"
  std::string title;    // "Rod in a helical conduit"
  std::string section;  // of the thesis: "II.3.3, IV.2; Figs. II.3.2, IV.2.1-4"
  std::string summary;  // one sentence
  Outcome (*compute)(const Progress& progress) = nullptr;
  double cost = 5.0;  // about how long it takes on one core [s]; weighs the progress of several and orders them
};

/// All of them, in the order of the thesis.
const std::vector<System>& systems();

}  // namespace tendril::reproduce
