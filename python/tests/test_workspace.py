"""The workspace: known facts, what a margin means, and the page."""

from __future__ import annotations

import json
import math
import re

import numpy as np
import pytest
import sms
from mechanism_support import random_poses
from plotly.offline import get_plotlyjs
from sms import workspace
from sms.report.workspace import workspace_html
from sms.workspace_findings import findings, to_dict
from sms.workspace_survey import Survey, survey

from validation.random_cases import draw

DEGREE = math.pi / 180.0


@pytest.fixture(scope="module")
def default() -> Survey:
    return survey()


def test_the_required_range_fits_at_no_height_and_says_so(default: Survey) -> None:
    required, specified = default.fits
    assert math.isnan(required.fits_from) and required.best_margin < -0.009
    assert (required.box.roll, required.box.pitch) == pytest.approx((8 * DEGREE, 4 * DEGREE))
    assert round(specified.fits_from, 3) == 0.491 and round(specified.fits_to, 3) == 0.506
    words = findings(default)
    assert words[0].startswith("±8° roll with ±4° pitch (required, Table 2.1) fits at no height")
    assert words[1].startswith("±6° roll with ±6° pitch (specified, Table 2.1) fits from 0.491 to")


def test_each_axis_alone_reaches_what_is_known(default: Survey) -> None:
    row = int(np.argmin(np.abs(default.heights - 0.5)))
    assert default.heights[row] == pytest.approx(0.5, abs=1e-12)
    assert default.either_way("roll")[row] == pytest.approx(9.7 * DEGREE, abs=0.05 * DEGREE)
    assert default.either_way("pitch")[row] == pytest.approx(8.5 * DEGREE, abs=0.05 * DEGREE)


def test_no_singularity_is_near(default: Survey) -> None:
    assert 1.0 < default.worst_of_all.panhard_condition < 1.12
    assert 1.0 < default.worst_of_all.link_condition < 1.75


def test_the_supply_carries_the_payload_until_it_does_not(default: Survey) -> None:
    assert default.push == pytest.approx(400e3 * 0.25 * math.pi * 0.1**2, rel=1e-9)
    assert default.pull < default.push
    assert "enough for the payload of 255 kg" in findings(default)[-1]
    weak = survey(sms.Params(supply_pressure=150e3))
    assert weak.worst_of_all.holding_share > 1.0
    assert "NOT ENOUGH" in findings(weak)[-1]


def test_reach_ends_where_the_stroke_does() -> None:
    random = draw("reach")
    height, direction = random.uniform(0.32, 0.67, 100), random.uniform(0.0, 2 * math.pi, 100)
    angle = workspace.reach(height, direction)
    edge = np.stack([angle * np.cos(direction), angle * np.sin(direction), height], axis=-1)
    assert np.abs(workspace.stroke_margin(edge)).max() < 1e-9
    inside = edge * (0.99, 0.99, 1.0)
    assert workspace.stroke_margin(inside).min() > 0.0


def test_a_box_that_fits_holds_every_pose_in_it() -> None:
    random = draw("rectangle")
    height, roll, pitch = 0.5, 0.09, 0.08
    margin = workspace.rectangle_margin(height, roll, pitch)
    q = random.uniform((-roll, -pitch, height), (roll, pitch, height), (5000, 3))
    least = workspace.stroke_margin(q).min()
    assert margin <= least + 1e-4
    assert workspace.rectangle_margin([0.4, 0.5], roll, pitch).shape == (2,)


def test_joints_are_where_they_were_at_rest_and_turn_from_there() -> None:
    rest = sms.forward_kinematics([0.0, 0.0, 0.0])
    still = workspace.joint_angles([rest.roll, rest.pitch, rest.height])
    assert max(still.base.max(), still.platform.max()) < 1e-7
    q = random_poses(draw("joints"), 100)
    turned = workspace.joint_angles(q)
    assert turned.base.shape == (100, 6)
    # A link's turn against the platform differs from that against the ground by the platform's.
    pose = sms.inverse_kinematics(q[:, 0], q[:, 1], q[:, 2])
    most = np.abs(q[:, 0]) + np.abs(q[:, 1]) + np.abs(pose.yaw)
    assert (np.abs(turned.base - turned.platform) <= most[:, None] + 1e-9).all()


def test_force_share_is_the_largest_force_over_what_there_is() -> None:
    q = random_poses(draw("share"), 50)
    force = sms.holding_force(q)
    push, _ = sms._core.force_range(sms.Params())
    assert workspace.force_share(q) == pytest.approx(force.max(axis=1) / push, rel=1e-12)


def test_errors_name_the_row() -> None:
    with pytest.raises(sms.OutOfWorkspaceError, match=r"^row 1: height = 0\.1 m.*0\.298 to 0\.693"):
        workspace.reach([0.5, 0.1], 0.0)
    with pytest.raises(sms.NotANumberError, match=r"^direction = nan rad"):
        workspace.reach(0.5, math.nan)
    with pytest.raises(sms.OutOfWorkspaceError, match=r"roll_limit = 0\.7 rad"):
        workspace.rectangle_margin(0.5, 0.7, 0.1)
    with pytest.raises(sms.OutOfWorkspaceError, match="stroke of 3 m: there is no workspace"):
        survey(sms.Params(stroke=3.0))


def test_the_page_stands_alone_and_is_drawn_from_the_survey(default: Survey) -> None:
    page = workspace_html(default)
    assert "fits at no height" in page
    assert "default-src 'none'" in page
    assert "://" not in page.replace(get_plotlyjs(), "")
    found = re.search(r'id="plot-data">(.*?)</script>', page, re.DOTALL)
    assert found
    data = json.loads(found[1])
    assert [o["height"] for o in data["outlines"]] == [300, 350, 400, 450, 500, 550, 600, 650]
    assert [o["height"] for o in data["outlines"] if o["best"]] == [500]
    assert [(b["roll"], b["pitch"]) for b in data["boxes"]] == [
        (pytest.approx(8.0), pytest.approx(4.0)),
        (pytest.approx(6.0), pytest.approx(6.0)),
    ]
    assert all(len(v) == len(data["height"]) for v in data["by_height"].values())


def test_as_plain_values_it_is_json(default: Survey) -> None:
    values = json.loads(json.dumps(to_dict(default), allow_nan=False))
    assert [box["fits"] for box in values["boxes"]] == [False, True]
    assert values["boxes"][0]["fits_from_m"] is None
    lengths = {len(column) for column in values["by_height"].values()}
    assert lengths == {default.heights.size}


def test_a_machine_with_a_short_stroke_has_a_small_workspace_and_a_page() -> None:
    small = survey(sms.Params(stroke=0.001))
    assert small.reach.max() < 0.01
    assert "fits at no height" in findings(small)[1]
    assert len(workspace_html(small)) > 1e6
