#include "tendril/segmentation/pattern_edit.hpp"

#include <algorithm>

namespace tendril::segmentation {

Pattern insert_point(const Pattern& q, int j, double S) {
  Pattern r = q;
  r.line.insert(r.line.begin() + j, 0);
  r.S.insert(r.S.begin() + j, S);
  return r;
}

Pattern remove_point(const Pattern& q, int k) {
  Pattern r = q;
  r.line.erase(r.line.begin() + k);
  r.S.erase(r.S.begin() + k);
  return r;
}

Pattern point_to_line(const Pattern& q, int k, double span) {
  Pattern r = q;
  const double S = q.S[k];
  r.line.insert(r.line.begin() + k + 1, 1);
  r.S[k] = S - 0.5 * span;
  r.S.insert(r.S.begin() + k + 1, S + 0.5 * span);
  return r;
}

Pattern point_to_two(const Pattern& q, int k, double span) {
  Pattern r = point_to_line(q, k, span);
  r.line[k + 1] = 0;
  return r;
}

Pattern split_line(const Pattern& q, int j, double S, double span, double S_left, double S_right) {
  Pattern r = q;
  const double a = S - 0.5 * span, b = S + 0.5 * span;
  const bool left_point = a <= S_left, right_point = b >= S_right;
  if (left_point) {  // the left end of the line stays as a point, then a free stretch, then the line
    r.line.insert(r.line.begin() + j, 0);
    r.S.insert(r.S.begin() + j, S_left + span);
    return r;
  }
  if (right_point) {
    r.line.insert(r.line.begin() + j + 1, 0);
    r.S.insert(r.S.begin() + j, S_right - span);
    return r;
  }
  r.line.insert(r.line.begin() + j + 1, {0, 1});
  r.S.insert(r.S.begin() + j, {a, b});
  return r;
}

Pattern remove_segment(const Pattern& q, int j) {
  Pattern r = q;
  const int n = static_cast<int>(q.line.size());
  if (n < 2) return r;
  if (j == 0) {
    r.line.erase(r.line.begin());
    r.S.erase(r.S.begin());
    return r;
  }
  if (j == n - 1) {
    r.line.pop_back();
    r.S.pop_back();
    return r;
  }
  const bool line_left = q.line[j - 1], line_right = q.line[j + 1];
  const double mid = 0.5 * (q.S[j - 1] + q.S[j]);
  r.line.erase(r.line.begin() + j);
  if (!q.line[j] && line_left && line_right) {  // line | free | line: one line
    r.line.erase(r.line.begin() + j);
    r.S.erase(r.S.begin() + j - 1, r.S.begin() + j + 1);
    return r;
  }
  // the two junctions become one: at the line's end when one neighbour is a line, else in the middle
  double S = mid;
  if (!q.line[j] && line_left) S = q.S[j - 1];
  if (!q.line[j] && line_right) S = q.S[j];
  r.S.erase(r.S.begin() + j);
  r.S[j - 1] = S;
  return r;
}

int point_contacts(const Pattern& q) {
  int n = 0;
  for (std::size_t j = 0; j + 1 < q.line.size(); ++j) n += !q.line[j] && !q.line[j + 1];
  return n;
}

int line_contacts(const Pattern& q) { return static_cast<int>(std::count(q.line.begin(), q.line.end(), 1)); }

}  // namespace tendril::segmentation
