/* The commands of ScipDevice that only report or set something, and the whole of SCIP 1.1. */
#include "lab/sim/device/scip_device.h"

#include <algorithm>
#include <cstdio>
#include <iterator>

namespace sim
{

namespace
{

constexpr int32_t rates[] = {19200, 38400, 57600, 115200, 250000, 500000, 750000};
constexpr size_t rate_digits = 6;

bool digits_only(const std::string &text)
{
    return !text.empty() &&
           std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c); });
}

bool is_rate(int32_t baud)
{
    return std::find(std::begin(rates), std::end(rates), baud) != std::end(rates);
}

std::string six_hex_digits(uint32_t value)
{
    char text[8];
    std::snprintf(text, sizeof text, "%06X", value & 0xffffffu);
    return text;
}

} // namespace

Reply ScipDevice::identity(const std::string &echo) const
{
    return ReplyWriter(echo, "00")
        .info("VEND", "Hokuyo Automatic Co.,Ltd.")
        .info("PROD", scanner_.product)
        .info("FIRM", scanner_.firmware)
        .info("PROT", "SCIP 2.0")
        .info("SERI", scanner_.serial)
        .reply();
}

Reply ScipDevice::parameters(const std::string &echo) const
{
    ReplyWriter writer(echo, "00");
    writer.info("MODL", scanner_.model)
        .info("DMIN", scanner_.min_mm)
        .info("DMAX", scanner_.max_mm)
        .info("ARES", scanner_.turn_steps)
        .info("AMIN", scanner_.first_step)
        .info("AMAX", scanner_.last_step)
        .info("AFRT", scanner_.front_step)
        .info("SCAN", scanner_.rpm);
    if (scanner_.recorded) {
        writer.info("PLAY", played());
    }
    return writer.reply();
}

/* Standby, time mode, laser on, scans on their way: as newer models than the URG-04LX count them. */
Reply ScipDevice::state(const std::string &echo) const
{
    const char *measuring = stream_ ? "004" : laser_ ? "003" : "000";
    return ReplyWriter(echo, "00").summed(time_mode_ ? "002" : measuring).reply();
}

Reply ScipDevice::condition(const std::string &echo) const
{
    const std::string origin = baud_ == rates[0] ? "<-Default setting by user" : "";
    return ReplyWriter(echo, "00")
        .info("MODL", scanner_.model)
        .info("LASR", laser_ ? "ON" : "OFF")
        .info("SCSP", "Initial(" + std::to_string(scanner_.rpm) + "[rpm])<-Default setting by user")
        .info("MESM", laser_ ? "CLASSIC" : "IDLE")
        .info("SBPS", std::to_string(baud_) + "[bps]" + origin)
        .info("TIME", six_hex_digits(clock_ms(now_us_)))
        .info("STAT", "Sensor works well.")
        .reply();
}

Reply ScipDevice::set_baud(const std::string &echo)
{
    const std::string digits = scip_parameter(echo);
    if (digits.size() < rate_digits) {
        return short_reply(echo, "0C");
    }
    if (digits.size() > rate_digits || !digits_only(digits)) {
        return short_reply(echo, "01");
    }
    const int32_t asked = std::stoi(digits);
    if (!is_rate(asked)) {
        return short_reply(echo, "02");
    }
    const bool already = asked == baud_;
    baud_ = asked;
    return short_reply(echo, already ? "03" : "00");
}

/* The simulated receiver has one sensitivity. */
Reply ScipDevice::sensitivity(const std::string &echo) const
{
    const std::string parameter = scip_parameter(echo);
    return short_reply(echo, parameter == "0" || parameter == "1" ? "03" : "01");
}

/* The simulated motor has one speed. */
Reply ScipDevice::motor_speed(const std::string &echo) const
{
    const std::string digits = scip_parameter(echo);
    if (digits.size() < 2) {
        return short_reply(echo, "0C");
    }
    if (digits.size() > 2 || !digits_only(digits)) {
        return short_reply(echo, "01");
    }
    if (digits == "00" || digits == "99") {
        return short_reply(echo, "03");
    }
    return short_reply(echo, digits <= "10" ? "04" : "02");
}

/* Status of a request for ranges that cannot be met; empty when it can. */
std::string ScipDevice::range_error(const std::string &command) const
{
    const bool stream = command[0] == 'M';
    const size_t full = stream ? 15 : 12;
    if (command.size() < full) {
        return "0C";
    }
    if (command.size() > full) {
        return "0E";
    }
    const struct {
        size_t at, count;
        const char *status;
    } fields[] = {{2, 4, "01"}, {6, 4, "02"}, {10, 2, "03"}, {12, 1, "06"}, {13, 2, "07"}};
    for (size_t k = 0; k < (stream ? 5u : 3u); k++) {
        if (!digits_only(command.substr(fields[k].at, fields[k].count))) {
            return fields[k].status;
        }
    }
    const int32_t first = std::stoi(command.substr(2, 4));
    const int32_t last = std::stoi(command.substr(6, 4));
    if (last > scanner_.end_step) {
        return "04";
    }
    return last < first ? "05" : "";
}

Reply ScipDevice::execute_scip1(const std::string &line)
{
    if (line == "SCIP2.0" && options_.protocol != Protocol::scip1_only) {
        protocol_ = ALE_SCIP_2;
        set_laser(false);
        return short_reply(line, "0");
    }
    switch (line[0]) {
    case 'V':
        return version_scip1(line);
    case 'L':
        return switch_laser_scip1(line);
    case 'S':
        return set_baud_scip1(line);
    case 'G':
        return get_scip1(line);
    default:
        return short_reply(line, "E");
    }
}

Reply ScipDevice::version_scip1(const std::string &line) const
{
    if (line.size() > 1) {
        return short_reply(line, "E");
    }
    const std::string ranges = "(" + std::to_string(scanner_.min_mm) + "-" + std::to_string(scanner_.max_mm) +
                               "[mm],240[deg]," + std::to_string(scanner_.first_step) + "-" +
                               std::to_string(scanner_.last_step) + "[step]," + std::to_string(scanner_.rpm) +
                               "[rpm])";
    return ReplyWriter(line, "0")
        .plain("VEND:Hokuyo Automatic Co.,Ltd.")
        .plain("PROD:" + scanner_.product)
        .plain("FIRM:" + scanner_.firmware + ranges)
        .plain("PROT:SCIP 1.1")
        .plain("SERI:" + scanner_.serial)
        .reply();
}

Reply ScipDevice::switch_laser_scip1(const std::string &line)
{
    if (line != "L0" && line != "L1") {
        return short_reply(line, "E");
    }
    const bool on = line == "L1";
    const bool already = on == laser_;
    set_laser(on);
    return short_reply(line, already ? "2" : "0");
}

Reply ScipDevice::set_baud_scip1(const std::string &line)
{
    constexpr size_t full = 14;
    if (line.size() != full || !digits_only(line.substr(1))) {
        return short_reply(line, "E");
    }
    const int32_t asked = std::stoi(line.substr(1, rate_digits));
    if (!is_rate(asked)) {
        return short_reply(line, "1");
    }
    baud_ = asked;
    return short_reply(line, "0");
}

Reply ScipDevice::get_scip1(const std::string &line)
{
    ale_scip_request_t request = {};
    const bool formed =
        ale_scip_request_parse(reinterpret_cast<const uint8_t *>(line.data()), line.size(), &request);
    if (!formed || request.last_step < request.first_step || request.last_step > scanner_.end_step) {
        return short_reply(line, "E");
    }
    if (!laser_) {
        return short_reply(line, "1");
    }
    return last_ranges(request, line);
}

} // namespace sim
