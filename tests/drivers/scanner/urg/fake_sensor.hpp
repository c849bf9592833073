// A URG-04LX as the data sheet and recordings describe it, in virtual time.
// Written on its own, without the project's encoder, so that a misreading of SCIP would have to be made
// twice.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <deque>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "drivers/scanner/fake_port.hpp"

namespace ale_test
{

inline std::string summed(const std::string &text)
{
    unsigned sum = 0;
    for (const char c : text) {
        sum += static_cast<unsigned char>(c);
    }
    return text + static_cast<char>((sum & 63U) + 0x30U);
}

inline std::string info(const std::string &text)
{
    const std::string with_sum = summed(text);
    return text + ";" + with_sum.back() + "\n";
}

inline std::string coded(uint32_t value, int characters)
{
    std::string text;
    for (int k = characters - 1; k >= 0; k--) {
        text += static_cast<char>(((value >> (6 * k)) & 63U) + 0x30U);
    }
    return text;
}

inline std::string data_lines(const std::string &data, bool sums)
{
    std::string lines;
    for (size_t k = 0; k < data.size(); k += 64) {
        const std::string part = data.substr(k, 64);
        lines += (sums ? summed(part) : part) + "\n";
    }
    return lines;
}

class FakeSensor : public FakeDevice
{
  public:
    // How this unit is made and wired.
    bool powers_up_in_1 = true; // classic; the UG01 powers up in 2.0
    bool can_switch = true;     // firmware 3 and later
    bool serves_once_a_turn = false;
    int32_t sensor_baud = 19200;
    int32_t turn_us = 100000;
    std::string serial = "H0706400";
    std::string wrong_lines; // extra lines of VV and V
    bool has_parameters = true;
    int32_t value_base = 1000;

    // Faults: a hand on every frame.
    std::function<std::string(const std::string &, int)> garble; // frame and its number
    std::function<int64_t(int)> delay_us;                        // of a frame

    // What happened.
    int protocol = 1;
    bool laser = false, streaming = false, time_mode = false, mute = false;
    std::vector<int> sent;           // numbers of the frames that left
    std::map<int, int64_t> truth_us; // when the beam passed step 0
    std::vector<std::string> commands;

    void power_cycle(int64_t clock_ms = 0)
    {
        protocol = powers_up_in_1 ? 1 : 2;
        laser = streaming = time_mode = false;
        waiting_.clear();
        input_.clear();
        set_clock(clock_ms);
    }
    void set_clock(int64_t clock_ms)
    {
        clock_zero_us_ = now_us - clock_ms * 1000;
    }
    void leave_streaming(const std::string &request)
    {
        protocol = 2;
        begin_stream(request);
    }
    void hear(const std::string &bytes) override
    {
        live();
        if (is_rs232 && port_baud != sensor_baud) {
            return;
        }
        input_ += bytes;
        for (size_t end; (end = input_.find('\n')) != std::string::npos;) {
            waiting_.push_back({serves_once_a_turn ? next_turn_us_ : now_us + 500, input_.substr(0, end)});
            input_.erase(0, end + 1);
        }
    }
    void say(const std::string &bytes)
    {
        if (!open || silent() || !plugged()) {
            return;
        }
        output_ += is_rs232 && port_baud != sensor_baud ? std::string(bytes.size() / 2, '\x80') : bytes;
    }
    void clear_line() override
    {
        FakeDevice::clear_line();
        input_.clear();
    }

  private:
    struct Waiting {
        int64_t at_us;
        std::string command;
    };
    struct Frame {
        int64_t at_us;
        std::string bytes;
        int number;
    };
    std::string input_, request_;
    std::deque<Waiting> waiting_;
    std::deque<Frame> frames_;
    int64_t clock_zero_us_ = 5000000;
    int64_t next_turn_us_ = 5100000;
    int turns_ = 0, skip_ = 0, skipped_ = 0;
    bool was_plugged_ = true;

    int64_t next_us() const override
    {
        int64_t at = next_turn_us_;
        if (!waiting_.empty()) {
            at = std::min(at, waiting_.front().at_us);
        }
        if (!frames_.empty()) {
            at = std::min(at, frames_.front().at_us);
        }
        return at;
    }
    void live() override
    {
        if (was_plugged_ && !plugged()) {
            was_plugged_ = false;
            output_.clear();
        } else if (!was_plugged_ && plugged()) {
            was_plugged_ = true;
            power_cycle();
        }
        while (now_us >= next_turn_us_) {
            end_turn();
        }
        while (!frames_.empty() && frames_.front().at_us <= now_us) {
            send_frame(frames_.front());
            frames_.pop_front();
        }
        while (!waiting_.empty() && waiting_.front().at_us <= now_us) {
            const std::string command = waiting_.front().command;
            waiting_.pop_front();
            if (!mute && !silent()) {
                obey(command);
            }
        }
    }
    uint32_t clock_ms(int64_t at_us) const
    {
        return static_cast<uint32_t>((at_us - clock_zero_us_) / 1000) & 0xffffffU;
    }
    std::string ranges(const std::string &request, int characters) const
    {
        const int first = std::stoi(request.substr(2, 4));
        const int last = std::stoi(request.substr(6, 4));
        const int cluster = std::max(1, std::stoi(request.substr(10, 2)));
        std::string data;
        for (int s = first; s <= last; s += cluster) {
            data += coded(static_cast<uint32_t>(value_base + turns_ % 1000), characters);
        }
        return data;
    }
    void end_turn()
    {
        const int64_t step_0_us = next_turn_us_ - turn_us;
        turns_++;
        if (streaming && skipped_++ >= skip_) {
            skipped_ = 0;
            const int characters = request_[1] == 'D' ? 3 : 2;
            const std::string bytes = request_ + "\n" + summed("99") + "\n" +
                                      summed(coded(clock_ms(step_0_us), 4)) + "\n" +
                                      data_lines(ranges(request_, characters), true) + "\n";
            truth_us[turns_ % 1000] = step_0_us;
            frames_.push_back({next_turn_us_ + 700 + (delay_us ? delay_us(turns_) : 0), bytes, turns_});
        }
        next_turn_us_ += turn_us;
    }
    void send_frame(const Frame &frame)
    {
        if (!open || silent() || !plugged() || !streaming) {
            return;
        }
        sent.push_back(frame.number % 1000);
        say(garble ? garble(frame.bytes, frame.number) : frame.bytes);
    }
    void begin_stream(const std::string &request)
    {
        request_ = request;
        skip_ = request[12] - '0';
        skipped_ = 0;
        laser = streaming = true;
    }
    void answer(const std::string &echo, const std::string &status, const std::string &lines = "")
    {
        say(echo + "\n" + (protocol == 1 ? status : summed(status)) + "\n" + lines + "\n");
    }
    void obey(const std::string &command)
    {
        commands.push_back(command);
        if (protocol == 1) {
            obey_1(command);
        } else {
            obey_2(command);
        }
    }
    void obey_1(const std::string &command)
    {
        if (command == "SCIP2.0" && can_switch) {
            answer(command, "0");
            protocol = 2;
        } else if (command == "V") {
            answer(command, "0",
                   "VEND:Hokuyo Automatic Co.,Ltd.\nPROD:SOKUIKI Sensor "
                   "URG-04LX\nFIRM:2.2.02(20-4095[mm],240[deg],"
                   "44-725[step],600[rpm])\nPROT:SCIP 1.1\nSERI:" +
                       serial + "\n" + wrong_lines);
        } else if (command.size() == 9 && command[0] == 'G') {
            const std::string as_2 =
                "GS0" + command.substr(1, 3) + "0" + command.substr(4, 3) + command.substr(7, 2);
            sent.push_back(turns_ % 1000);
            answer(command, "0", data_lines(ranges(as_2, 2), false));
        } else if (!command.empty()) {
            answer(command, "E");
        }
    }
    void obey_2(const std::string &command)
    {
        const std::string symbol = command.substr(0, 2);
        if (command == "TM2" && time_mode) {
            time_mode = false;
            answer(command, "00");
        } else if (time_mode) {
            answer(command, "0E");
        } else if (command == "QT") {
            streaming = laser = false;
            frames_.clear();
            answer(command, "00");
        } else if (command == "RS") {
            streaming = laser = false;
            set_clock(0);
            answer(command, "00");
        } else if (command == "VV") {
            answer(command, "00",
                   info("VEND:Hokuyo Automatic Co.,Ltd.") + info("PROD:SOKUIKI Sensor URG-04LX") +
                       wrong_lines + info("FIRM:3.1.04(02/Aug./2007)") + info("PROT:SCIP 2.0") +
                       info("SERI:" + serial));
        } else if (command == "PP" && has_parameters) {
            answer(command, "00",
                   info("MODL:URG-04LX(Hokuyo Automatic Co.,Ltd.)") + info("DMIN:20") + info("DMAX:5600") +
                       info("ARES:1024") + info("AMIN:44") + info("AMAX:725") + info("AFRT:384") +
                       info("SCAN:" + std::to_string(60000000 / turn_us)));
        } else if (command == "II") {
            answer(command, "00", info("LASR:OFF") + info("STAT:Sensor works well."));
        } else if (symbol == "SS") {
            answer(command, "00");
            sensor_baud = std::stoi(command.substr(2));
        } else if (command.size() == 15 && command[0] == 'M') {
            begin_stream(command);
            answer(command, "00");
        } else if (!command.empty()) {
            answer(command, "0E");
        }
    }
};

} // namespace ale_test
