// SPDX-License-Identifier: Apache-2.0
#include "calib/report/figures/drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

#include "calib/report/figures/escaped.h"

namespace mgtd::calib::report::figures {
namespace {

struct ToneColours {
  const char *name, *light, *dark;
};

constexpr std::array<ToneColours, kTones> kColours{{{"none", "none", "none"},
                                                    {"ink", "#1d2329", "#e6eaee"},
                                                    {"quiet", "#5a646e", "#a3adb7"},
                                                    {"rule", "#dde2e6", "#343c45"},
                                                    {"paper", "#ffffff", "#14181d"},
                                                    {"blue", "#0072b2", "#4aa8e0"},
                                                    {"vermilion", "#d55e00", "#f58a3c"},
                                                    {"green", "#00825f", "#2cc79a"},
                                                    {"purple", "#a8478a", "#e08cc4"},
                                                    {"sky", "#56b4e9", "#7cc9f2"},
                                                    {"amber", "#b07d00", "#e8b93a"},
                                                    {"grey", "#8b939b", "#7f8993"}}};

const ToneColours& colours(Tone tone) { return kColours[static_cast<std::size_t>(tone)]; }

std::string joined_places(const std::vector<Place>& places) {
  std::string out;
  for (const Place& p : places) out += (out.empty() ? "" : " ") + coordinate(p.x) + "," + coordinate(p.y);
  return out;
}

std::string rules_of(bool dark) {
  std::string out;
  for (const ToneColours& c : kColours) {
    if (std::string_view(c.name) == "none") continue;
    const char* const colour = dark ? c.dark : c.light;
    out += fmt::format("svg .f-{0}{{fill:{1}}}svg .s-{0}{{stroke:{1}}}", c.name, colour);
  }
  return out;
}

}  // namespace

std::string coordinate(double value) {
  std::string out = fmt::format("{:.1f}", value);
  if (out.ends_with(".0")) out.resize(out.size() - 2);
  return out == "-0" ? "0" : out;
}

Drawing::Drawing(std::string name, double width, double height)
    : name_(std::move(name)), width_(width), height_(height) {}

void Drawing::open(const Style& style, std::string_view css_class) {
  std::string classes(css_class);
  const auto add = [&](std::string_view kind, Tone tone) {
    if (tone == Tone::none) return;
    if (!classes.empty()) classes += ' ';
    classes += fmt::format("{}-{}", kind, colours(tone).name);
  };
  add("f", style.fill);
  add("s", style.stroke);
  body_ += fmt::format("<g class=\"{}\" fill=\"{}\"", escaped(classes), colours(style.fill).light);
  if (style.stroke != Tone::none) body_ += fmt::format(" stroke=\"{}\"", colours(style.stroke).light);
  if (style.stroke != Tone::none && style.width != 1)
    body_ += fmt::format(" stroke-width=\"{:g}\"", style.width);
  if (*style.dash != '\0') body_ += fmt::format(" stroke-dasharray=\"{}\"", style.dash);
  if (style.opacity < 1) body_ += fmt::format(" opacity=\"{:.2f}\"", style.opacity);
  body_ += ">";
}

void Drawing::close() { body_ += "</g>\n"; }

void Drawing::line(Place from, Place to) {
  fmt::format_to(std::back_inserter(body_), "<line x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\"/>",
                 coordinate(from.x), coordinate(from.y), coordinate(to.x), coordinate(to.y));
}

void Drawing::polyline(const std::vector<Place>& places) {
  if (places.size() < 2) return;
  body_ += "<polyline fill=\"none\" points=\"" + joined_places(places) + "\"/>";
}

void Drawing::polyline_within(const std::vector<Place>& places, double x, double y, double width,
                              double height) {
  std::vector<Place> part;
  for (std::size_t i = 1; i < places.size(); ++i) {
    const Place a = places[i - 1], b = places[i];
    // Of a + t (b - a) the part that is inside (Liang and Barsky).
    double from = 0, to = 1;
    const double dx = b.x - a.x, dy = b.y - a.y;
    for (const auto& [step, room] :
         {std::pair{-dx, a.x - x}, {dx, x + width - a.x}, {-dy, a.y - y}, {dy, y + height - a.y}}) {
      if (step == 0 && room < 0) to = -1;
      if (step < 0) from = std::max(from, room / step);
      if (step > 0) to = std::min(to, room / step);
    }
    if (from > to) {
      polyline(part), part.clear();
      continue;
    }
    if (from > 0 || part.empty()) {
      polyline(part), part.clear();
      part.push_back({a.x + from * dx, a.y + from * dy});
    }
    part.push_back({a.x + to * dx, a.y + to * dy});
    if (to < 1) polyline(part), part.clear();
  }
  polyline(part);
}

void Drawing::polygon(const std::vector<Place>& places) {
  if (places.size() < 3) return;
  body_ += "<polygon points=\"" + joined_places(places) + "\"/>";
}

void Drawing::rect(double x, double y, double width, double height) {
  fmt::format_to(std::back_inserter(body_), "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/>",
                 coordinate(x), coordinate(y), coordinate(std::max(0.0, width)),
                 coordinate(std::max(0.0, height)));
}

void Drawing::ellipse(Place centre, double rx, double ry) {
  fmt::format_to(std::back_inserter(body_), "<ellipse cx=\"{}\" cy=\"{}\" rx=\"{}\" ry=\"{}\"/>",
                 coordinate(centre.x), coordinate(centre.y), coordinate(rx), coordinate(ry));
}

void Drawing::mark(Shape shape, Place at, double radius, int pose) {
  const std::string data = pose < 0 ? "" : fmt::format(" data-p=\"{}\"", pose);
  const auto to = std::back_inserter(body_);
  const double r = radius;
  if (shape == Shape::circle) {
    fmt::format_to(to, "<circle{} cx=\"{}\" cy=\"{}\" r=\"{}\"/>", data, coordinate(at.x), coordinate(at.y),
                   coordinate(r));
    return;
  }
  std::string path;
  switch (shape) {
    case Shape::square:
      path = fmt::format("h{0}v{0}h-{0}z", coordinate(1.8 * r));
      at = {at.x - 0.9 * r, at.y - 0.9 * r};
      break;
    case Shape::triangle:
      path = fmt::format("l{0} {1}h-{2}z", coordinate(1.1 * r), coordinate(1.9 * r), coordinate(2.2 * r));
      at = {at.x, at.y - 1.2 * r};
      break;
    case Shape::diamond:
      path = fmt::format("l{0} {0}l-{0} {0}l-{0} -{0}z", coordinate(1.2 * r));
      at = {at.x, at.y - 1.2 * r};
      break;
    default:
      path = fmt::format("l{0} {0}m0 -{0}l-{0} {0}", coordinate(1.8 * r));
      at = {at.x - 0.9 * r, at.y - 0.9 * r};
  }
  fmt::format_to(to, "<path{} d=\"M{} {}{}\"/>", data, coordinate(at.x), coordinate(at.y), path);
}

void Drawing::text(Place at, std::string_view text, Anchor anchor, Tone tone, double size, bool bold) {
  static constexpr std::array<const char*, 3> kAnchors{"start", "middle", "end"};
  body_ += fmt::format("<text class=\"f-{}\" x=\"{}\" y=\"{}\"", colours(tone).name, coordinate(at.x),
                       coordinate(at.y));
  if (anchor != Anchor::start)
    body_ += fmt::format(" text-anchor=\"{}\"", kAnchors[static_cast<std::size_t>(anchor)]);
  if (size != kFontSize) body_ += fmt::format(" font-size=\"{:g}\"", size);
  if (bold) body_ += " font-weight=\"600\"";
  body_ += fmt::format(" fill=\"{}\">{}</text>", colours(tone).light, escaped(text));
}

void Drawing::text_over(Place at, std::string_view text, Anchor anchor, Tone tone) {
  body_ += fmt::format(
      "<g class=\"s-paper\" stroke=\"{}\" stroke-width=\"3\" stroke-linejoin=\"round\" "
      "paint-order=\"stroke\">",
      colours(Tone::paper).light);
  this->text(at, text, anchor, tone);
  body_ += "</g>";
}

void Drawing::text_up(Place at, std::string_view text, Tone tone) {
  body_ += fmt::format(
      "<text class=\"f-{}\" transform=\"translate({} {}) rotate(-90)\" text-anchor=\"middle\" "
      "fill=\"{}\">{}</text>",
      colours(tone).name, coordinate(at.x), coordinate(at.y), colours(tone).light, escaped(text));
}

void Drawing::text_down(Place at, std::string_view text, double size) {
  body_ += fmt::format(
      "<text class=\"f-ink\" transform=\"translate({} {}) rotate(90)\" font-size=\"{:g}\" "
      "fill=\"{}\">{}</text>",
      coordinate(at.x), coordinate(at.y), size, colours(Tone::ink).light, escaped(text));
}

void Drawing::hatch(double x, double y, double width, double height) {
  constexpr double kStep = 6;
  open({.fill = Tone::rule, .opacity = 0.45});
  rect(x, y, width, height);
  close();
  open({.stroke = Tone::grey, .width = 0.8}, "hatch");
  // Lines x + y = constant, cut at the rectangle.
  for (double sum = x + y + kStep; sum < x + width + y + height; sum += kStep) {
    const double x1 = std::min(x + width, sum - y), x2 = std::max(x, sum - y - height);
    line({x1, sum - x1}, {x2, sum - x2});
  }
  open({.stroke = Tone::grey, .width = 0.8});
  rect(x, y, width, height);
  close();
  close();
}

std::string Drawing::finished(std::string_view title, std::string_view description) const {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" role=\"img\" "
      "aria-labelledby=\"{2}-title "
      "{2}-desc\" font-family=\"DejaVu Sans, Verdana, sans-serif\" font-size=\"{3:g}\"><title "
      "id=\"{2}-title\">{4}"
      "</title><desc id=\"{2}-desc\">{5}</desc>\n{6}</svg>",
      coordinate(width_), coordinate(height_), escaped(name_), kFontSize, escaped(title),
      escaped(description), body_);
}

std::string drawing_style() {
  // On paper the colours are those of the light screen.
  return rules_of(false) + "@media screen and (prefers-color-scheme:dark){" + rules_of(true) + "}";
}

}  // namespace mgtd::calib::report::figures
