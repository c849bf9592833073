#include "lab/sim/device/rplidar_device.h"

#include <cmath>
#include <map>

namespace sim
{

namespace
{

enum Request : uint8_t {
    sync_byte = 0xa5,
    stop = 0x25,
    reset = 0x40,
    scan = 0x20,
    force_scan = 0x21,
    express_scan = 0x82,
    get_info = 0x50,
    get_health = 0x52,
    get_rates = 0x59,
    get_configuration = 0x84,
    motor_speed = 0xa8,
    motor_pwm = 0xf0,
    get_board = 0xff
};

enum Entry : uint32_t {
    desired_speed = 0x01,
    mode_count = 0x70,
    sample_duration = 0x71,
    longest_range = 0x74,
    answer_type = 0x75,
    typical_mode = 0x7c,
    mode_name = 0x7f
};

constexpr int64_t boot_us = 500000;
constexpr uint8_t fault = 2; /* of health */
constexpr unsigned bright = 47;

void put(std::string &out, uint64_t value, int count)
{
    for (int k = 0; k < count; k++) {
        out += static_cast<char>(value >> (8 * k));
    }
}

std::string little(uint64_t value, int count)
{
    std::string out;
    put(out, value, count);
    return out;
}

uint32_t byte_at(const std::string &bytes, size_t at)
{
    return static_cast<uint8_t>(bytes[at]);
}

/* An answer, or what comes before measurements, which are repeated. */
std::string with_descriptor(uint8_t type, const std::string &payload)
{
    std::string out = "\xa5\x5a";
    put(out, payload.size(), 4);
    put(out, type, 1);
    return out + payload;
}

std::string stream_descriptor(RplidarScan type)
{
    std::string out = "\xa5\x5a";
    put(out, (type == RplidarScan::standard ? 5U : 84U) | 1U << 30U, 4);
    put(out, static_cast<uint8_t>(type), 1);
    return out;
}

unsigned sixty_fourths(double degrees)
{
    return static_cast<unsigned>(std::llround(degrees * 64)) % (360 * 64);
}

/* The head of a capsule, its sum made. */
std::string capsule(double start, bool anew, const std::string &rest)
{
    std::string summed;
    put(summed, sixty_fourths(start) | (anew ? 0x8000U : 0U), 2);
    summed += rest;
    unsigned sum = 0;
    for (const char c : summed) {
        sum ^= static_cast<uint8_t>(c);
    }
    std::string out;
    put(out, 0xa0U | (sum & 0xfU), 1);
    put(out, 0x50U | sum >> 4U, 1);
    return out + summed;
}

/* Points lie evenly by their times; what a point is off from that, it says in eighths of a degree: nothing
 * here. */
std::string cabins(const std::vector<Echo> &echoes)
{
    std::string out;
    for (size_t k = 0; k + 1 < echoes.size(); k += 2) {
        put(out, static_cast<uint64_t>(echoes[k].mm) << 2U & 0xfffcU, 2);
        put(out, static_cast<uint64_t>(echoes[k + 1].mm) << 2U & 0xfffcU, 2);
        put(out, 0, 1);
    }
    return out;
}

std::string distances(const std::vector<Echo> &echoes)
{
    std::string out;
    for (const Echo &echo : echoes) {
        put(out, static_cast<uint64_t>(echo.mm), 2);
    }
    return out;
}

size_t points_of(RplidarScan type)
{
    switch (type) {
    case RplidarScan::express:
        return 32;
    case RplidarScan::dense:
        return 40;
    default:
        return 1;
    }
}

} // namespace

RplidarDevice::RplidarDevice(const RplidarModel &model) : model_(model)
{
    power_up(0);
}

void RplidarDevice::power_up(int64_t now_us)
{
    scan_ = RplidarScan::none;
    turning_ = !model_.motor_by_command;
    error_ = 0;
    heard_.clear();
    answers_.clear();
    waiting_.clear();
    deaf_until_us_ = now_us > 0 ? now_us + boot_us : 0;
}

bool RplidarDevice::wanted(bool) const
{
    return wanted_;
}

bool RplidarDevice::streaming() const
{
    return scan_ != RplidarScan::none && turning_;
}

/* Whole bytes of the request at the beginning of what was heard; 0: it is not all there. */
size_t RplidarDevice::request_size() const
{
    if (heard_.size() < 2) {
        return 0;
    }
    if ((byte_at(heard_, 1) & 0x80U) == 0) {
        return 2;
    }
    const size_t size = heard_.size() > 2 ? byte_at(heard_, 2) + 4U : SIZE_MAX;
    return size <= heard_.size() ? size : 0;
}

void RplidarDevice::receive(std::string_view bytes, int64_t now_us)
{
    if (now_us < deaf_until_us_) {
        return;
    }
    heard_ += bytes;
    while (!heard_.empty()) {
        if (byte_at(heard_, 0) != sync_byte) {
            heard_.erase(0, 1);
            continue;
        }
        const size_t size = request_size();
        if (size == 0) {
            return;
        }
        obey();
        heard_.erase(0, size);
        deaf_until_us_ = deaf_until_us_ < 0 ? now_us + boot_us : deaf_until_us_;
    }
}

void RplidarDevice::begin(RplidarScan type)
{
    if (error_ == fault) {
        return;
    }
    scan_ = type;
    anew_ = true;
    waiting_.clear();
    wanted_ = true;
    answers_.push_back(stream_descriptor(type));
}

void RplidarDevice::obey()
{
    using Deed = void (RplidarDevice::*)();
    static const std::map<uint8_t, Deed> deeds = {
        {stop, &RplidarDevice::end},
        {reset, &RplidarDevice::boot},
        {scan, &RplidarDevice::begin_standard},
        {force_scan, &RplidarDevice::begin_standard},
        {express_scan, &RplidarDevice::begin_other},
        {get_info, &RplidarDevice::tell_info},
        {get_health, &RplidarDevice::tell_health},
        {get_rates, &RplidarDevice::tell_rates},
        {get_configuration, &RplidarDevice::tell_configuration},
        {motor_speed, &RplidarDevice::set_motor},
        {motor_pwm, &RplidarDevice::set_motor},
        {get_board, &RplidarDevice::tell_board},
    };
    const auto known = deeds.find(static_cast<uint8_t>(heard_[1]));
    if (known != deeds.end()) {
        (this->*known->second)();
    }
}

void RplidarDevice::end()
{
    scan_ = RplidarScan::none;
}

void RplidarDevice::boot()
{
    power_up(0);
    deaf_until_us_ = -1; /* from now on */
}

void RplidarDevice::begin_standard()
{
    begin(RplidarScan::standard);
}

void RplidarDevice::begin_other()
{
    begin(other_scan());
}

void RplidarDevice::set_motor()
{
    turning_ = byte_at(heard_, 3) + byte_at(heard_, 4) > 0;
}

void RplidarDevice::tell_info()
{
    std::string payload;
    put(payload, model_.model, 1);
    put(payload, model_.firmware, 2);
    put(payload, model_.hardware, 1);
    for (int k = 0; k < 16; k++) {
        put(payload, static_cast<uint64_t>(0xb0 + k), 1);
    }
    answers_.push_back(with_descriptor(0x04, payload));
}

void RplidarDevice::tell_health()
{
    std::string payload;
    put(payload, error_, 1);
    put(payload, error_ == 0 ? 0 : 0x8001, 2);
    answers_.push_back(with_descriptor(0x06, payload));
}

void RplidarDevice::tell_rates()
{
    std::string payload;
    put(payload, static_cast<uint64_t>(model_.standard_us), 2);
    put(payload, static_cast<uint64_t>(model_.express_us), 2);
    answers_.push_back(with_descriptor(0x15, payload));
}

void RplidarDevice::tell_board()
{
    std::string payload;
    put(payload, model_.motor_by_command ? 1 : 0, 4);
    answers_.push_back(with_descriptor(0xff, payload));
}

RplidarScan RplidarDevice::other_scan() const
{
    return model_.typical == RplidarScan::standard ? RplidarScan::dense : model_.typical;
}

/* What an entry of the configuration holds for a mode; nothing: it has none. Mode 0 is the standard scan,
 * mode 1 the other. */
std::string RplidarDevice::entry(uint32_t number, bool is_standard) const
{
    const RplidarScan type = is_standard ? RplidarScan::standard : other_scan();
    const double sample_us = is_standard ? model_.standard_us : model_.express_us;
    const char *other_name = other_scan() == RplidarScan::dense ? "DenseBoost" : "Express";
    std::string speed;
    put(speed, 600, 2);
    put(speed, 660, 2);
    const std::map<uint32_t, std::string> entries = {
        {desired_speed, speed},
        {mode_count, little(2, 2)},
        {sample_duration, little(static_cast<uint64_t>(256 * sample_us), 4)},
        {longest_range, little(static_cast<uint64_t>(model_.max_m) << 8U, 4)},
        {answer_type, little(static_cast<uint8_t>(type), 1)},
        {typical_mode, little(model_.typical == RplidarScan::standard ? 0 : 1, 2)},
        {mode_name, std::string(is_standard ? "Standard" : other_name) + '\0'},
    };
    const auto known = entries.find(number);
    return known == entries.end() ? "" : known->second;
}

void RplidarDevice::tell_configuration()
{
    if (!model_.has_configuration || byte_at(heard_, 2) < 4) {
        return;
    }
    const uint32_t number = byte_at(heard_, 3) | byte_at(heard_, 4) << 8U | byte_at(heard_, 5) << 16U;
    const bool is_standard = byte_at(heard_, 2) < 6 || byte_at(heard_, 7) == 0;
    const std::string held = entry(number, is_standard);
    if (!held.empty()) {
        answers_.push_back(with_descriptor(0x20, little(number, 4) + held));
    }
}

std::vector<Reply> RplidarDevice::answer(int64_t)
{
    std::vector<Reply> out;
    for (; !answers_.empty(); answers_.pop_front()) {
        out.push_back({answers_.front(), std::nullopt, false});
    }
    return out;
}

std::optional<int64_t> RplidarDevice::answer_due_us() const
{
    return answers_.empty() ? std::nullopt : std::optional<int64_t>(0);
}

/* A fault of its hardware: it stops, and says so when it is asked. */
void RplidarDevice::break_stream(const std::string &)
{
    error_ = fault;
    scan_ = RplidarScan::none;
}

std::string RplidarDevice::node_of(const Echo &echo)
{
    const bool starts = echo.clockwise < last_clockwise_;
    last_clockwise_ = echo.clockwise;
    std::string node;
    put(node, (starts ? 1U : 2U) | (echo.mm > 0 ? bright << 2U : 0U), 1);
    put(node, sixty_fourths(echo.clockwise) << 1U | 1U, 2);
    put(node, static_cast<uint64_t>(echo.mm) << 2U, 2);
    return node;
}

/* What the points that wait make, as soon as they are enough. */
std::string RplidarDevice::piece()
{
    if (waiting_.size() < points_of(scan_)) {
        return "";
    }
    std::string out;
    if (scan_ == RplidarScan::standard) {
        out = node_of(waiting_.front());
    } else {
        out = capsule(waiting_.front().clockwise, anew_,
                      scan_ == RplidarScan::express ? cabins(waiting_) : distances(waiting_));
    }
    anew_ = false;
    waiting_.clear();
    return out;
}

/* The standard scan leaves points out that the others have. */
std::vector<Reply> RplidarDevice::sweep(const Sweep &sweep, int64_t device_start_us)
{
    if (!streaming() || device_start_us < stalled_until_us_) {
        return {};
    }
    const auto each = static_cast<uint32_t>(std::lround(model_.standard_us / model_.express_us));
    Reply reply = {"", std::nullopt, true};
    for (const Echo &echo : sweep.echoes) {
        if (scan_ != RplidarScan::standard || points_++ % each == 0) {
            waiting_.push_back(echo);
        }
        reply.bytes += piece();
    }
    if (sweep.begins_turn) {
        reply.turn_start_us = std::llround(sweep.start_us);
    }
    return reply.bytes.empty() ? std::vector<Reply>() : std::vector<Reply>{reply};
}

} // namespace sim
