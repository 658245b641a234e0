"""Inputs that contradict physics turn their own check red, and only that one."""

from __future__ import annotations

import pytest

from templates.build import TEMPLATES

SAME_WAY = {"beta_1": 180, "beta_2": 180, "s_1": 9, "s_2": 36, "EES_1": 1, "EES_2": 1, "phi_1": 0, "phi_2": 0}
# Template, the check that must fail, the inputs that make it (the others as in the empty template).
CASES = [
    ("skid", "check_slowing", {"grade": -10, "f_2": 0.05}),
    ("skid", "check_slowing", {"grade": -60, "f_1": 1.1, "f_2": 1.1, "f_3": 1.1}),
    ("skid", "check_lengths", {"d_2": -5}),
    ("skid", "check_friction", {"f_1": 7.5}),
    ("skid", "check_friction", {"braking": 1.5}),
    ("skid", "check_end", {"v_end": -1}),
    ("critical-speed-yaw", "check_arc", {"chord": 4, "ordinate": 100}),
    ("critical-speed-yaw", "check_arc", {"ordinate": -4, "offset": -1000}),
    ("critical-speed-yaw", "check_radius", {"offset": 400, "f": 0.5}),
    ("critical-speed-yaw", "check_friction", {"f": 7.5}),
    ("critical-speed-yaw", "check_slowing", {"chord_later": 100, "ordinate_later": 3}),
    ("collinear", "check_closing check_order", {"known": 1, "V1_before": 10, "V2_before": 20}),
    ("collinear", "check_restitution", {"e": 1.2}),
    ("collinear", "check_restitution check_order", {"e": -0.2}),
    ("collinear", "check_forward", {"known": 1, "V1_before": -10, "V2_before": -20}),
    ("collinear", "check_claim", {"V1_claimed": 90}),
    ("collinear", "check_way", {"known": 1, "V1_before": 20, "V2_before": -10, "t_impact": 0.1, "f_braked": 0.6}),
    # Off centre, restitutions of opposite sign can add energy although each is below 1.
    ("planar-forward", "check_energy", {"e_n": 0.95, "e_t": -0.95, "gamma_t": 113, "x_1": 90, "y_1": -40, "y_2": -11}),
    ("planar-forward", "check_closing check_push", {"gamma_t": 281, "V1_before": 5, "V2_before": 60, "alpha_2": 190}),
    ("planar-forward", "check_restitution", {"e_t": 1.05, "gamma_t": 100}),
    ("planar-forward", "check_ratio", {"mu": -0.5}),
    ("planar-forward", "check_forward", {"V2_before": -1}),
    ("planar-forward", "check_ratio", {"mu": 55}),
    ("planar-forward", "check_friction", {"f_1": 75}),
    ("crush-energy", "check_tests", {"line_1": 1}),
    ("crush-energy", "check_crush", {"c_1_3": -2}),
    ("crush-energy", "check_stiffness", {"b0_2": -0.1}),
    ("crush-energy", "check_restitution", {"e": -0.1}),
    ("crush-energy", "check_balance", {"L_2": 20}),
    ("crush-energy", "check_oblique", {"theta_1": 50, "L_1": 40}),
    ("pedestrian-throw", "check_distance", {"s": 0}),
    ("pedestrian-throw", "check_friction", {"mu": 6.6}),
    ("pedestrian-throw", "check_distance", {"H": -0.1}),
    ("pedestrian-throw", "check_angle", {"angle": 100}),
    ("pedestrian-throw", "check_efficiency", {"efficiency": 1.1}),
    ("momentum", "check_energy", {"alpha_1": 110, "alpha_2": 150, "beta_1": 150, "beta_2": 30}),
    ("momentum", "check_angles", {"alpha_1": 340, "alpha_2": 169, "beta_1": 300, "beta_2": 270}),
    ("momentum", "check_forward", {"alpha_1": 190, "alpha_2": 100, "beta_1": 300, "beta_2": 230}),
    ("momentum", "check_friction", {"f_1": 1.3, "s_1": 12}),
    ("time-distance", "check_inputs", {"clearance": -1}),
    ("time-distance", "check_moves", {"a_intruder": 0}),
    ("time-distance", "check_friction", {"f": 70}),
    ("time-distance", "check_braked", {"d_brake": 0}),
    ("time-distance", "check_response", {"d_intruder": 1.5, "a_intruder": 0.3, "d_brake": 60}),
    ("airborne", "check_fall", {"theta": -20}),
    ("airborne", "check_fall", {"h": -25}),  # a landing that is lower, entered as higher
    ("airborne", "check_distance", {"s": -1}),
    ("airborne", "check_angle", {"theta": 50}),
    ("airborne", "check_friction", {"f": 45}),
    ("airborne", "check_friction", {"f": 0}),
    ("airborne", "check_time", {"h": 200}),
    ("airborne", "check_steepness", {"h": 2}),
    ("edr-speed", "check_samples", {"n_on": 7}),
    ("edr-speed", "check_last check_forward", {"v_last": 0}),
    ("edr-speed", "check_share", {"kappa": 0.6}),
    ("edr-speed", "check_friction", {"f": 1.3}),
    ("edr-speed", "check_time", {"tau": -0.1}),
    ("edr-speed", "check_table", {"rec_begun": 5}),
    ("edr-speed", "check_restitution", {"e": -0.1}),
    ("edr-speed", "check_forward", {"v_last": 2}),
    ("video-speed", "check_order check_frames", {"n": 0, "u_1": 1, "u_2": 0}),
    ("video-speed", "check_shares", {"u_1": 3}),
    ("video-speed", "check_tyres", {"a": 1.3}),
    ("video-speed", "check_forward", {"d": 5, "a": 0.9}),
    ("video-speed", "check_frames", {"n": 4}),
    ("video-speed", "check_table", {"rec_begun": 5}),
    ("momentum-energy", "check_reach check_balance", {"beta_1": 90, "beta_2": 90, "s_2": 900}),
    ("momentum-energy", "check_forward", SAME_WAY),
    ("momentum-energy", "check_crush", {"EES_1": -10}),
    ("momentum-energy", "check_spin", {"mu_1": 35}),
    ("momentum-energy", "check_friction", {"f_1": 1.3, "s_1": 12}),
    ("momentum-energy", "check_run_out", {"share_2_2": 70}),
    ("momentum", "check_run_out", {"share_1_2": 70}),
    ("pedestrian", "check_lengths check_braked", {"d_before": -1}),
    ("pedestrian", "check_known", {"d_after": 0}),
    ("pedestrian", "check_friction", {"f": 1.3}),
    ("pedestrian", "check_body", {"mu": 6.6}),
    ("pedestrian", "check_known", {"s": 0, "known": 2}),
    ("pedestrian", "check_braked", {"d_before": 0}),
    ("pedestrian", "check_angle", {"angle": 100}),
    ("pedestrian", "check_efficiency", {"efficiency": 1.1}),
    ("pedestrian", "check_walking", {"walking": 16, "walked": 40}),
    ("pedestrian", "check_response", {"walked": 2}),
    ("low-speed", "check_closing", {"V2_before": 20}),
    ("low-speed", "check_restitution", {"e": 1.2}),
    ("low-speed", "check_friction", {"f_2": 30}),
    ("low-speed", "check_bumpers", {"kappa": 3}),
    ("low-speed", "check_low", {"V1_before": 30}),
    ("low-speed", "check_forward", {"f_1": 0.5, "w_1": 300}),
    ("low-speed", "check_way", {"V2_before": -3}),
    ("motorcycle", "check_lengths", {"d_slide": -1}),
    ("motorcycle", "check_friction", {"f_slide": 51.5}),
    ("motorcycle", "check_body", {"mu": 6.6}),
    ("motorcycle", "check_angle", {"angle": 100}),
    ("motorcycle", "check_efficiency", {"efficiency": 1.1}),
    ("motorcycle", "check_known", {"known": 4}),
    ("motorcycle", "check_known", {"known": 3, "s": 0}),
    ("motorcycle", "check_crossing check_conditioning", {"alpha_2": 175}),
    ("motorcycle", "check_conditioning", {"beta_2": 86}),
    ("motorcycle", "check_forward", {"beta_2": 120}),
    ("motorcycle", "check_energy", {"s_1": 60, "beta_1": 250}),
    ("beam", "check_beam", {"span": -24}),
    ("beam", "check_loads", {"live": -1}),
    ("beam", "check_steel", {"fy": 345}),
    ("beam", "check_factors", {"fabrication": 100}),
    ("tolerance-stack", "check_parts", {"ring": -0.492}),
    ("tolerance-stack", "check_limits", {"gap_min": 0.02}),
    ("tolerance-stack", "check_metal", {"a_housing": 0.0128, "a_parts": 6500}),
    ("mass-calibration", "check_density", {"rho_W": 8}),
    ("mass-calibration", "check_air", {"rho_a": 0.0012}),
    ("mass-calibration", "check_mass", {"m_Rc": 100}),
    ("project", "check_days", {"t_site": -45}),
    ("project", "check_dates", {"deadline": 46000}),
    ("project", "check_budget", {"budget": 0}),
    ("project", "check_risks", {"r_permit": 0.25}),
    ("warranty", "check_life", {"shape": -1.8}),
    ("warranty", "check_share check_claims", {"share_refused": 5, "claims": 20_000}),
    # An impulse that pulls always adds energy too.
    ("momentum", "check_energy check_closing", {"alpha_1": 80, "alpha_2": 310, "beta_1": 60, "beta_2": 250}),
]


@pytest.mark.parametrize(("template", "failing", "changes"), CASES)
def test_a_contradiction_turns_its_check_red(template, failing, changes, cells, described):
    names = [row.symbol for row in described[template].equations if row.role.value == "check"]
    result = {symbol: value.item() for symbol, value in cells(template, changes, names).items()}
    assert result.pop("checks_hold") == 0
    assert [symbol for symbol, holds in result.items() if not holds] == failing.split()


def test_every_check_of_every_template_is_tried(described):
    """Those of planar-impact are in test_planar_impact.py, check_repairs of a table of data in test_other_fields.py.

    check_identity of time-distance and check_least of airborne hold for all inputs: they are for formulas typed over.
    """
    tried = {(template, symbol) for template, failing, _ in CASES for symbol in failing.split()}
    checks = {
        (name, row.symbol)
        for name in TEMPLATES
        if name != "planar-impact"
        for row in described[name].equations
        if row.role.value == "check" and row.symbol != "checks_hold"
    }
    elsewhere = {("time-distance", "check_identity"), ("airborne", "check_least"), ("warranty", "check_repairs")}
    assert tried == checks - elsewhere
