#include "lab/sim/faults.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <sstream>

#include "common/command_line/words.h"

namespace sim
{

namespace
{

struct Description {
    const char *name;
    FaultKind kind;
    bool has_argument;
    double usual;
    double most;
};

constexpr Description descriptions[] = {
    {"flip", FaultKind::flip, false, 0, 0},          {"cut", FaultKind::cut, false, 0, 0},
    {"garbage", FaultKind::garbage, true, 300, 1e5}, {"repeat", FaultKind::repeat, false, 0, 0},
    {"silence", FaultKind::silence, true, 2, 3600},  {"unplug", FaultKind::unplug, true, 2, 3600},
    {"reset11", FaultKind::reset11, false, 0, 0},    {"hardware", FaultKind::hardware, true, 50, 97},
    {"wrap", FaultKind::wrap, false, 0, 0},          {"stall", FaultKind::stall, true, 2, 3600},
};

constexpr double longest_s = 1e6;
constexpr uint64_t own_stream = 0xfa017;

[[noreturn]] void fail(const std::string &fault, const std::string &what)
{
    throw cli::WrongUse("--faults " + fault + ": " + what);
}

double number(const std::string &text, double most, const std::string &fault)
{
    return cli::number_of("--faults " + fault + ":", text, 0.0, most);
}

const Description &describe(const std::string &name, const std::string &fault)
{
    const auto *found = std::find_if(std::begin(descriptions), std::end(descriptions),
                                     [&](const Description &d) { return name == d.name; });
    if (found == std::end(descriptions)) {
        fail(fault, "no fault is called \"" + name + "\"");
    }
    return *found;
}

Fault parse_fault(const std::string &text)
{
    const size_t at = text.find('@');
    if (at == std::string::npos) {
        fail(text, "when? (NAME[:ARGUMENT]@SECONDS or @#SCAN)");
    }
    const std::string what = text.substr(0, at);
    const std::string when = text.substr(at + 1);
    const size_t colon = what.find(':');
    const Description description = describe(what.substr(0, colon), text);
    Fault fault = {description.kind, description.usual, -1, -1};
    if (colon != std::string::npos) {
        if (!description.has_argument) {
            fail(text, "takes no argument");
        }
        fault.argument = number(what.substr(colon + 1), description.most, text);
    }
    if (!when.empty() && when[0] == '#') {
        fault.at_scan = std::llround(number(when.substr(1), longest_s, text));
    } else {
        fault.at_us = std::llround(number(when, longest_s, text) * 1e6);
    }
    if (fault.kind == FaultKind::wrap && fault.at_us < 0) {
        fail(text, "needs a time, not a scan");
    }
    return fault;
}

bool on_the_frame(const Fault &fault)
{
    return fault.kind == FaultKind::flip || fault.kind == FaultKind::cut ||
           fault.kind == FaultKind::garbage || fault.kind == FaultKind::repeat;
}

bool has_come(const Fault &fault, int64_t play_us, int64_t scan)
{
    return fault.at_scan >= 0 ? scan >= fault.at_scan : play_us >= fault.at_us;
}

} // namespace

std::vector<Fault> parse_faults(const std::string &spec)
{
    std::vector<Fault> faults;
    std::istringstream parts(spec);
    for (std::string part; std::getline(parts, part, ',');) {
        faults.push_back(parse_fault(part));
    }
    return faults;
}

Faults::Faults(const std::string &spec, uint64_t seed)
    : pending_(parse_faults(spec)), random_(seed ^ own_stream)
{
}

std::optional<int64_t> Faults::wrap_us() const
{
    for (const Fault &fault : pending_) {
        if (fault.kind == FaultKind::wrap) {
            return fault.at_us;
        }
    }
    return std::nullopt;
}

int64_t Faults::next_due_us() const
{
    int64_t next = INT64_MAX;
    for (const Fault &fault : pending_) {
        if (!on_the_frame(fault) && fault.kind != FaultKind::wrap && fault.at_us >= 0) {
            next = std::min(next, fault.at_us);
        }
    }
    return next;
}

std::vector<Fault> Faults::due(int64_t play_us, int64_t scan)
{
    std::vector<Fault> now;
    const auto ready = [&](const Fault &fault) {
        return !on_the_frame(fault) && fault.kind != FaultKind::wrap && has_come(fault, play_us, scan);
    };
    std::copy_if(pending_.begin(), pending_.end(), std::back_inserter(now), ready);
    pending_.erase(std::remove_if(pending_.begin(), pending_.end(), ready), pending_.end());
    return now;
}

std::string Faults::damage_by(const Fault &fault, const std::string &frame)
{
    std::string out = frame;
    switch (fault.kind) {
    case FaultKind::flip: {
        const int last = static_cast<int>(frame.size()) - 1;
        char &byte = out[static_cast<size_t>(random_.integer(0, last))];
        byte = static_cast<char>(static_cast<unsigned>(byte) ^ 1U << random_.integer(0, 6));
        return out;
    }
    case FaultKind::cut:
        return frame.substr(0, frame.size() / 2);
    case FaultKind::garbage: {
        std::string garbage(static_cast<size_t>(fault.argument), '\0');
        std::generate(garbage.begin(), garbage.end(),
                      [&] { return static_cast<char>(random_.integer(0, 255)); });
        return garbage + frame;
    }
    case FaultKind::repeat:
        return frame + frame;
    default:
        return frame;
    }
}

std::string Faults::damage(const std::string &frame, int64_t play_us, int64_t scan)
{
    std::string out = frame;
    const auto ready = [&](const Fault &fault) {
        return on_the_frame(fault) && has_come(fault, play_us, scan);
    };
    for (const Fault &fault : pending_) {
        if (!frame.empty() && ready(fault)) {
            out = damage_by(fault, out);
        }
    }
    if (!frame.empty()) {
        pending_.erase(std::remove_if(pending_.begin(), pending_.end(), ready), pending_.end());
    }
    return out;
}

} // namespace sim
