// What a flight recording says of a scan.
#include <memory>
#include <string>

#include <gtest/gtest.h>

extern "C" {
#include "recorder/flight_words.h"
}

namespace
{

TEST(FlightWords, ADecisionSaysWhichMapItWasMadeInAndWhatTheWheelsDid)
{
    const auto result = std::make_unique<ale_result_t>();
    result->estimate.scan = 7;
    result->estimate.map_id = 2;
    result->estimate.maps = 3;
    result->estimate.wheel_fault = ALE_WHEELS_LATE;
    result->estimate.wheel_faults = 5;
    const ale_flight_result_t kept = ale_flight_result(result.get());
    char text[ALE_FLIGHT_MAX_PAYLOAD];
    const std::string words(text, ale_flight_decision(&kept, text));
    EXPECT_EQ(words.rfind("scan=7 ", 0), 0U);
    EXPECT_NE(words.find(" map_id=2 maps=3 wheel_fault=4 wheel_faults=5\n"), std::string::npos) << words;
}

} // namespace
