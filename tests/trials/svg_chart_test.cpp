// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/trials/svg_chart.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "eyeslam/files/markup.h"
#include "eyeslam/simulation/random.h"
#include "support/xml_check.h"

namespace eyeslam::trials {
namespace {

using files::escaped;
using support::XmlCheck;

double distanceToWay(const Eigen::Vector2d& point, const Points& way)
{
  double nearest = 1e12;
  for (std::size_t i = 1; i < way.size(); ++i) {
    const Eigen::Vector2d step = way[i] - way[i - 1];
    const double t = std::clamp((point - way[i - 1]).dot(step) / std::max(step.squaredNorm(), 1e-18), 0.0, 1.0);
    nearest = std::min(nearest, (way[i - 1] + t * step - point).norm());
  }
  return nearest;
}

TEST(XmlCheck, FindsWhatIsWrong)
{
  EXPECT_EQ(XmlCheck::faultOf("<a b=\"1\"><c/>x &amp; y</a>\n"), "");
  for (const char* wrong : {"<a>", "<a></b>", "<a b=1/>", "<a b=\"1\" b=\"2\"/>", "<a>x & y</a>", "<a>1 < 2</a>", "x"})
    EXPECT_NE(XmlCheck::faultOf(wrong), "") << wrong;
}

TEST(Escaped, TextStaysTextWhateverItSays)
{
  EXPECT_EQ(escaped("<b a=\"x\">'&"), "&lt;b a=&quot;x&quot;&gt;&#39;&amp;");
  EXPECT_EQ(escaped("12 \u00b5m \u2013 \U0001F441"), "12 \u00b5m \u2013 \U0001F441");
}

TEST(Escaped, WhatIsNoUtf8OrForbiddenInXmlBecomesAQuestionMark)
{
  EXPECT_EQ(escaped("a\x01"
                    "b\xff"
                    "c\xc3"),
            "a?b?c?");
  EXPECT_EQ(escaped("\xc0\xaf"), "??");            // '/' in two bytes
  EXPECT_EQ(escaped("\xed\xa0\x80"), "???");       // half of a pair of UTF-16
  EXPECT_EQ(escaped("\xf4\x90\x80\x80"), "????");  // beyond the last letter
}

TEST(Escaped, RandomBytesAreWellFormedXml)
{
  simulation::Random random(3);
  for (int run = 0; run < 300; ++run) {
    std::string bytes;
    for (int i = 0; i < 40; ++i) bytes += static_cast<char>(random.bits() & 0xffU);
    EXPECT_EQ(XmlCheck::faultOf("<a b=\"" + escaped(bytes) + "\">" + escaped(bytes) + "</a>"), "");
  }
}

TEST(SvgChart, IsWellFormedWithHostileNames)
{
  SvgCanvas canvas(400, 300, "<\"&'>");
  SvgChart chart(canvas, boxAt(60, 30, 300, 200), {"t & <s>", 0, 10}, Axis::decades("\"um\"", 0.3, 700));
  chart.title("a < b & c");
  chart.shade(2, 3, Paint::area("#eee"));
  chart.axes();
  chart.curve({0, 5, 10}, {1, 10, 100}, Paint::line("#000"));
  chart.band({0, 5, 10}, {1, 2, 3}, {4, 5, 6}, Paint::area("#000", 0.5));
  chart.dot(1, 1, 3, Paint::area("#000"), "seed <1> & 2");
  chart.legend({{"<i>", Paint::line("#000")}, {"&", Paint::area("#111")}});
  EXPECT_EQ(XmlCheck::faultOf(canvas.svg()), "");
}

TEST(SvgChart, PlacesValuesWhereTheAxesSay)
{
  SvgCanvas canvas(400, 300, "");
  const SvgChart linear(canvas, boxAt(50, 20, 200, 100), {"", 0, 10}, {"", 0, 4});
  EXPECT_TRUE(linear.place(0, 0).isApprox(Eigen::Vector2d(50, 120)));
  EXPECT_TRUE(linear.place(5, 1).isApprox(Eigen::Vector2d(150, 95)));
  const SvgChart decades(canvas, boxAt(50, 20, 200, 100), {"", 1, 100, true}, {"", 0, 4});
  EXPECT_NEAR(decades.place(10, 0).x(), 150, 1e-9);
}

TEST(Axis, DecadesHoldBothEndsAndHaveTicksThere)
{
  for (const auto& [least, greatest] : {std::pair{0.37, 412.0}, {10.0, 10.0}, {3.0, 9.9}, {0.001, 5e4}}) {
    const Axis axis = Axis::decades("", least, greatest);
    EXPECT_LE(axis.from, least * 1.000001);
    EXPECT_GE(axis.to, greatest * 0.999999);
    EXPECT_GE(ticksOf(axis, 5).size(), 2U);
  }
}

TEST(Envelope, HidesNoPeak)
{
  simulation::Random random(5);
  std::vector<double> x, y;
  for (int i = 0; i < 20000; ++i) {
    x.push_back(1e-3 * i);
    y.push_back(random.uniform());
  }
  y[12345] = 77.0;
  y[19999] = -5.0;
  const Envelope drawn = envelope(x, y, 900);
  EXPECT_EQ(drawn.x.size(), 900U);
  EXPECT_EQ(*std::max_element(drawn.high.begin(), drawn.high.end()), 77.0);
  EXPECT_EQ(*std::min_element(drawn.low.begin(), drawn.low.end()), -5.0);
  EXPECT_EQ(envelope({1.0}, {2.0}, 900).high, std::vector<double>{2.0});
  EXPECT_TRUE(envelope({}, {}, 900).x.empty());
}

TEST(Simplified, StaysWithinItsToleranceOfEveryPoint)
{
  simulation::Random random(9);
  Points points;
  Eigen::Vector2d place(0, 0);
  for (int i = 0; i < 3000; ++i) {
    place += Eigen::Vector2d(random.normal(), random.normal()) * 0.2;
    points.push_back(place);
  }
  const Points way = simplified(points, 0.5);
  EXPECT_LT(way.size(), points.size() / 2);
  EXPECT_EQ(way.front(), points.front());
  EXPECT_EQ(way.back(), points.back());
  for (std::size_t i = 0; i < points.size(); i += 7) EXPECT_LE(distanceToWay(points[i], way), 0.5 + 1e-9);
}

}  // namespace
}  // namespace eyeslam::trials
