// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <vector>

/// A Drawing writes a picture as SVG text, element by element. Coordinates are in units of the viewBox, y
/// downwards, written with one decimal: the same values give the same text.
///
/// A colour is a presentation attribute, so that the text alone is a complete picture for a paper, and a
/// class, so that the style of a page (figure_style()) can set other colours for a dark screen. There is no
/// inline style, no script and no reference to anything outside.
namespace mgtd::calib::report::figures {

/// Blue, vermilion, green and purple can be told apart with every kind of colour vision (Okabe and Ito).
enum class Tone { none, ink, quiet, rule, paper, blue, vermilion, green, purple, sky, amber, grey };
inline constexpr int kTones = 12;

struct Style {
  Tone fill{Tone::none}, stroke{Tone::none};
  double width{1};       ///< of the stroke
  const char* dash{""};  ///< "4 3"
  double opacity{1};
};

enum class Anchor { start, middle, end };

struct Place {
  double x{0}, y{0};
};

/// Shapes of marks, so that sensors are told apart without colour too.
enum class Shape { circle, square, triangle, diamond, cross };

inline constexpr double kFontSize = 11;

class Drawing {
 public:
  /// `name` begins every id in it: letters, digits, '-' and '.'.
  Drawing(std::string name, double width, double height);

  [[nodiscard]] double width() const { return width_; }
  [[nodiscard]] double height() const { return height_; }
  [[nodiscard]] const std::string& name() const { return name_; }

  /// What follows up to close() has this style.
  void open(const Style& style, std::string_view css_class = "");
  void close();
  void line(Place from, Place to);
  void polyline(const std::vector<Place>& places);
  /// What of it lies in the rectangle.
  void polyline_within(const std::vector<Place>& places, double x, double y, double width, double height);
  /// Closed and filled.
  void polygon(const std::vector<Place>& places);
  void rect(double x, double y, double width, double height);
  void ellipse(Place centre, double rx, double ry);
  /// `pose`: number of the pose that the mark stands for, as data-p; negative: none.
  void mark(Shape shape, Place at, double radius, int pose = -1);
  void text(Place at, std::string_view text, Anchor anchor = Anchor::start, Tone tone = Tone::ink,
            double size = kFontSize, bool bold = false);
  /// The same over what is drawn already, with a rim that keeps it readable.
  void text_over(Place at, std::string_view text, Anchor anchor = Anchor::start, Tone tone = Tone::ink);
  /// Read upwards, its middle at `at`.
  void text_up(Place at, std::string_view text, Tone tone = Tone::ink);
  /// Read downwards, from `at` on.
  void text_down(Place at, std::string_view text, double size = kFontSize);
  /// Stripes over a rectangle: what is not known.
  void hatch(double x, double y, double width, double height);

  /// The whole element. `title` and `description` are what a reader of the screen says.
  [[nodiscard]] std::string finished(std::string_view title, std::string_view description) const;

 private:
  std::string name_;
  double width_, height_;
  std::string body_;
};

/// One decimal, none where it is zero; never NaN: the caller has looked.
[[nodiscard]] std::string coordinate(double value);

/// Colours of the classes for light and dark screens and for paper, as CSS.
[[nodiscard]] std::string drawing_style();

}  // namespace mgtd::calib::report::figures
