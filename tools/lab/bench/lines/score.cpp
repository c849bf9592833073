#include "lab/bench/lines/score.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

namespace bench
{
namespace
{

constexpr double same_share = 0.75;
constexpr double same_direction = radians(10);
constexpr double same_place = 0.1;
constexpr double corner_reach = 0.05;

int overlap(int a, int b, int c, int d)
{
    return std::max(0, std::min(b, d) - std::max(a, c) + 1);
}

int beams(const Line &line)
{
    return line.last - line.first + 1;
}

// One extracted line beside successive visible pieces of one wall.
struct Pairing {
    double share;
    std::size_t line;
    std::vector<std::size_t> pieces;
};

// The extracted line's parameters with its normal on the side of the true one.
NormalForm turned_towards(const NormalForm &form, double alpha)
{
    return std::abs(wrapped(form.alpha - alpha)) > pi / 2 ? NormalForm{form.alpha + pi, -form.rho} : form;
}

double shared_beams_ratio(const Line &line, const Truth &truth, const std::vector<std::size_t> &pieces)
{
    int true_beams = 0;
    int common = 0;
    int hidden = 0;
    for (std::size_t k = 0; k < pieces.size(); k++) {
        const TrueLine &piece = truth.lines[pieces[k]];
        true_beams += piece.last - piece.first + 1;
        common += overlap(line.first, line.last, piece.first, piece.last);
        if (k > 0) {
            hidden += overlap(line.first, line.last, truth.lines[pieces[k - 1]].last + 1, piece.first - 1);
        }
    }
    return static_cast<double>(common) / std::max(true_beams, beams(line) - hidden);
}

bool touches_both_ends(const Line &line, const Truth &truth, const std::vector<std::size_t> &pieces)
{
    return line.first <= truth.lines[pieces.front()].last && line.last >= truth.lines[pieces.back()].first;
}

bool in_the_same_place(const Line &line, const Truth &truth, const std::vector<std::size_t> &pieces)
{
    const double alpha = truth.lines[pieces.front()].form.alpha;
    const NormalForm form = turned_towards(line.form, alpha);
    Point middle = Point::Zero();
    for (const std::size_t p : pieces) {
        middle += (truth.lines[p].start + truth.lines[p].end) / (2.0 * static_cast<double>(pieces.size()));
    }
    return std::abs(wrapped(form.alpha - alpha)) < same_direction &&
           std::abs(form.distance(middle)) < same_place;
}

std::map<int, std::vector<std::size_t>> pieces_by_wall(const Truth &truth)
{
    std::map<int, std::vector<std::size_t>> walls;
    for (std::size_t k = 0; k < truth.lines.size(); k++) {
        walls[truth.lines[k].wall].push_back(k);
    }
    return walls;
}

// All pairings good enough to be a match, the best first.
std::vector<Pairing> possible_pairings(const Truth &truth, const std::vector<Line> &lines)
{
    std::vector<Pairing> all;
    const auto walls = pieces_by_wall(truth);
    for (std::size_t l = 0; l < lines.size(); l++) {
        for (const auto &[wall, pieces] : walls) {
            for (std::size_t from = 0; from < pieces.size(); from++) {
                for (std::size_t to = from; to < pieces.size(); to++) {
                    const std::vector<std::size_t> chosen(pieces.begin() + static_cast<std::ptrdiff_t>(from),
                                                          pieces.begin() + static_cast<std::ptrdiff_t>(to) +
                                                              1);
                    const double share = shared_beams_ratio(lines[l], truth, chosen);
                    if (share >= same_share && touches_both_ends(lines[l], truth, chosen) &&
                        in_the_same_place(lines[l], truth, chosen)) {
                        all.push_back({share, l, chosen});
                    }
                }
            }
        }
    }
    std::stable_sort(all.begin(), all.end(),
                     [](const Pairing &a, const Pairing &b) { return a.share > b.share; });
    return all;
}

bool too_short(const Line &line)
{
    return beams(line) < 8 || (line.end - line.start).norm() < 0.12;
}

bool on_a_line_too_short_to_count(const Line &line, const Truth &truth)
{
    return std::any_of(truth.lines.begin(), truth.lines.end(), [&](const TrueLine &t) {
        return !t.counts && overlap(line.first, line.last, t.first, t.last) >= same_share * beams(line);
    });
}

void measure_parameters(Tally &tally, const Truth &truth, const Pairing &pair, const Line &line)
{
    const NormalForm &truth_form = truth.lines[pair.pieces.front()].form;
    const NormalForm form = turned_towards(line.form, truth_form.alpha);
    const double da = wrapped(form.alpha - truth_form.alpha);
    const double dr = form.rho - truth_form.rho;
    double squared = 0;
    for (const std::size_t p : pair.pieces) {
        const auto &information = truth.lines[p].information;
        squared += da * da * information[0] + 2 * da * dr * information[1] + dr * dr * information[2];
    }
    tally.error_squared.push_back(squared);
}

double outside(double value, std::array<double, 2> between)
{
    const auto [low, high] = std::minmax({between[0], between[1]});
    return std::max({low - value, value - high, 0.0});
}

void measure_ends(Tally &tally, const Truth &truth, const Pairing &pair, const Line &line)
{
    const Point tangent = truth.lines[pair.pieces.front()].form.tangent();
    const auto [low, high] = std::minmax({tangent.dot(line.start), tangent.dot(line.end)});
    tally.end_error.push_back(outside(low, truth.lines[pair.pieces.front()].start_between));
    tally.end_error.push_back(outside(high, truth.lines[pair.pieces.back()].end_between));
}

void score_lines(Tally &tally, const Truth &truth, const std::vector<Line> &lines)
{
    std::set<std::size_t> used;
    std::set<std::size_t> found;
    for (const Pairing &pair : possible_pairings(truth, lines)) {
        const bool taken = std::any_of(pair.pieces.begin(), pair.pieces.end(),
                                       [&](std::size_t p) { return found.count(p) > 0; });
        if (taken || used.count(pair.line) > 0) {
            continue;
        }
        used.insert(pair.line);
        found.insert(pair.pieces.begin(), pair.pieces.end());
        if (std::any_of(pair.pieces.begin(), pair.pieces.end(),
                        [&](std::size_t p) { return truth.lines[p].counts; })) {
            measure_parameters(tally, truth, pair, lines[pair.line]);
            measure_ends(tally, truth, pair, lines[pair.line]);
        }
    }
    for (std::size_t k = 0; k < truth.lines.size(); k++) {
        tally.true_lines += truth.lines[k].counts;
        tally.found_lines += truth.lines[k].counts && found.count(k) > 0;
    }
    for (std::size_t l = 0; l < lines.size(); l++) {
        const bool judged = !too_short(lines[l]) && !on_a_line_too_short_to_count(lines[l], truth);
        tally.judged_lines += judged;
        tally.false_lines += judged && used.count(l) == 0;
    }
}

struct CornerPair {
    double distance;
    std::size_t extracted;
    std::size_t truth;
};

void score_corners(Tally &tally, const Truth &truth, const std::vector<Point> &corners)
{
    std::vector<CornerPair> pairs;
    for (std::size_t i = 0; i < corners.size(); i++) {
        for (std::size_t j = 0; j < truth.corners.size(); j++) {
            const double distance = (corners[i] - truth.corners[j].p).norm();
            if (distance <= corner_reach) {
                pairs.push_back({distance, i, j});
            }
        }
    }
    std::sort(pairs.begin(), pairs.end(),
              [](const CornerPair &a, const CornerPair &b) { return a.distance < b.distance; });
    std::set<std::size_t> used;
    std::set<std::size_t> found;
    for (const CornerPair &pair : pairs) {
        if (used.count(pair.extracted) > 0 || found.count(pair.truth) > 0) {
            continue;
        }
        used.insert(pair.extracted);
        found.insert(pair.truth);
        if (truth.corners[pair.truth].counts) {
            tally.corner_error.push_back(pair.distance);
            tally.found_corners++;
            tally.judged_corners++;
        }
    }
    for (const TrueCorner &corner : truth.corners) {
        tally.true_corners += corner.counts;
    }
    tally.judged_corners += static_cast<int>(corners.size() - used.size());
}

double per_cent(int part, int whole)
{
    return whole > 0 ? 100.0 * part / whole : std::nan("");
}

double quantile(std::vector<double> values, double share)
{
    if (values.empty()) {
        return std::nan("");
    }
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size()));
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

double mean(const std::vector<double> &values)
{
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

} // namespace

void Tally::add(const Tally &other)
{
    true_lines += other.true_lines;
    found_lines += other.found_lines;
    judged_lines += other.judged_lines;
    false_lines += other.false_lines;
    true_corners += other.true_corners;
    found_corners += other.found_corners;
    judged_corners += other.judged_corners;
    error_squared.insert(error_squared.end(), other.error_squared.begin(), other.error_squared.end());
    end_error.insert(end_error.end(), other.end_error.begin(), other.end_error.end());
    corner_error.insert(corner_error.end(), other.corner_error.begin(), other.corner_error.end());
}

double Tally::true_positive() const
{
    return per_cent(found_lines, true_lines);
}

double Tally::false_positive() const
{
    return per_cent(false_lines, judged_lines);
}

double Tally::error_rms() const
{
    return std::sqrt(mean(error_squared) / 2);
}

// The median of a chi-square of two degrees of freedom is 2 ln 2.
double Tally::error_median() const
{
    return std::sqrt(quantile(error_squared, 0.5) / (2 * std::log(2.0)));
}

double Tally::end_median() const
{
    return quantile(end_error, 0.5);
}

double Tally::end_90() const
{
    return quantile(end_error, 0.9);
}

double Tally::corner_precision() const
{
    return per_cent(found_corners, judged_corners);
}

double Tally::corner_recall() const
{
    return per_cent(found_corners, true_corners);
}

double Tally::corner_rms() const
{
    double sum = 0;
    for (const double e : corner_error) {
        sum += e * e;
    }
    return std::sqrt(sum / static_cast<double>(corner_error.size()));
}

std::vector<Point> derived_corners(const std::vector<Line> &lines)
{
    std::vector<Point> corners;
    for (std::size_t k = 0; k + 1 < lines.size(); k++) {
        const Line &a = lines[k];
        const Line &b = lines[k + 1];
        const double determinant = std::sin(b.form.alpha - a.form.alpha);
        if (b.first - a.last > 5 || std::abs(determinant) < std::sin(radians(15))) {
            continue;
        }
        const Point meet(
            (a.form.rho * std::sin(b.form.alpha) - b.form.rho * std::sin(a.form.alpha)) / determinant,
            (b.form.rho * std::cos(a.form.alpha) - a.form.rho * std::cos(b.form.alpha)) / determinant);
        const auto nearest_end = [&](const Line &line) {
            return std::min((line.start - meet).norm(), (line.end - meet).norm());
        };
        if (std::max(nearest_end(a), nearest_end(b)) < 0.15) {
            corners.push_back(meet);
        }
    }
    return corners;
}

Tally score(const Truth &truth, const Extraction &extraction)
{
    Tally tally;
    score_lines(tally, truth, extraction.lines);
    score_corners(tally, truth, extraction.corners);
    return tally;
}

} // namespace bench
