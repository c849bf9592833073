#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

extern "C" {
#include "scanner/urg/baud.h"
#include "scanner/urg/identity.h"
}

namespace
{

class Identity : public testing::Test
{
  protected:
    ale_urg_identity_t identity{};
    void SetUp() override
    {
        ale_urg_identity_init(&identity);
    }
    void lines(std::initializer_list<const char *> texts, bool sum_right = true)
    {
        for (const char *text : texts) {
            ale_urg_identity_line(&identity, text, sum_right);
        }
    }
};

TEST_F(Identity, lines_are_taken_by_key_in_any_order)
{
    lines({"SERI:H0706400", "unknown", "XXXX:what", "FIRM:3.1.04(02/Aug./2007)",
           "PROD:SOKUIKI Sensor URG-04LX", "SCAN:300", "AFRT:360", "AMAX:720", "AMIN:0", "ARES:720",
           "DMAX:30000", "DMIN:60", "MODL:URG-04LX(Hokuyo Automatic Co.,Ltd.)", "STAT:Sensor works well."});
    EXPECT_STREQ(identity.device.serial, "H0706400");
    EXPECT_STREQ(identity.device.model, "URG-04LX(Hokuyo Automatic Co.,Ltd.)");
    EXPECT_STREQ(identity.status, "Sensor works well.");
    EXPECT_EQ(identity.geometry.steps_per_turn, 720);
    EXPECT_EQ(identity.geometry.range_max_mm, 30000);
    EXPECT_EQ(ale_urg_period_us(&identity.geometry), 200000);
    EXPECT_TRUE(ale_urg_geometry_valid(&identity.geometry));
    EXPECT_EQ(identity.warnings, 0U);
}

TEST_F(Identity, numbers_under_a_wrong_sum_are_not_believed_texts_are_shown)
{
    lines({"DMAX:9600", "SERI:H1234567"}, false);
    EXPECT_EQ(identity.geometry.range_max_mm, 5600);
    EXPECT_STREQ(identity.device.serial, "H1234567");
    EXPECT_EQ(identity.warnings, 2U);
}

TEST_F(Identity, senseless_numbers_are_refused)
{
    const char *const senseless[] = {"ARES:0", "ARES:100", "AMIN:800", "SCAN:0", "DMAX:10", "AMAX:99999"};
    for (const char *line : senseless) {
        SetUp();
        lines({line});
        EXPECT_FALSE(ale_urg_geometry_valid(&identity.geometry)) << line;
    }
    SetUp();
    lines({"AMIN:-3", "DMIN:", "SCAN:abc", "ARES:99999999999"});
    EXPECT_TRUE(ale_urg_geometry_valid(&identity.geometry)) << "unreadable numbers change nothing";
    EXPECT_EQ(identity.warnings, 4U);
}

TEST_F(Identity, first_firmware_states_its_geometry_in_brackets)
{
    lines({"FIRM:2.2.02,03/Jan./2006(20-4095[mm],240[deg],44-725[step],600[rpm])"});
    EXPECT_EQ(identity.geometry.range_max_mm, 4095);
    SetUp();
    lines({"FIRM:3.1.04(02/Aug./2007)"});
    EXPECT_EQ(identity.geometry.range_max_mm, 5600);
}

TEST_F(Identity, endless_text_is_cut)
{
    const std::string line = "SERI:" + std::string(150, 'x');
    lines({line.c_str()});
    EXPECT_EQ(strlen(identity.device.serial), sizeof identity.device.serial - 1);
}

TEST(Baud, every_rate_is_tried_once_and_the_preferred_one_first)
{
    for (const int32_t preferred : {0, 115200, 19200, 750000, 460800}) {
        std::vector<int32_t> tried;
        for (uint32_t k = 0; k < ALE_BAUD_RATES; k++) {
            tried.push_back(ale_baud_candidate(preferred, k));
        }
        EXPECT_EQ(tried[0], preferred == 0 ? 115200 : preferred);
        std::sort(tried.begin(), tried.end());
        EXPECT_EQ(std::unique(tried.begin(), tried.end()), tried.end());
    }
}

TEST(Baud, stream_is_fitted_to_the_line_as_its_budget_says)
{
    const struct {
        int32_t baud;
        int characters, cluster, skip;
    } rows[] = {{750000, 3, 1, 0}, {500000, 3, 1, 0}, {250000, 3, 1, 0},
                {115200, 3, 2, 0}, {57600, 3, 2, 1},  {19200, 2, 2, 4}};
    for (const auto &row : rows) {
        ale_scip_request_t request{};
        request.protocol = 2;
        request.stream = true;
        request.first_step = 44;
        request.last_step = 725;
        request.characters = 3;
        ale_baud_fit(&request, row.baud, 100000);
        EXPECT_EQ(request.characters, row.characters) << row.baud;
        EXPECT_EQ(request.cluster, row.cluster) << row.baud;
        EXPECT_EQ(request.skip, row.skip) << row.baud;
        EXPECT_LT(ale_baud_time_us(row.baud, ale_scip_request_frame_bytes(&request)),
                  100000 * (row.skip + 1));
    }
}

TEST(Baud, wishes_of_the_configuration_are_the_least)
{
    ale_scip_request_t request{};
    request.protocol = 2;
    request.stream = true;
    request.last_step = 768;
    request.characters = 2;
    request.cluster = 3;
    request.skip = 2;
    ale_baud_fit(&request, 750000, 100000);
    EXPECT_EQ(request.characters, 2);
    EXPECT_EQ(request.cluster, 3);
    EXPECT_EQ(request.skip, 2);
}

} // namespace
