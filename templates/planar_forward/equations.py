"""The forward impact model: eqs (1) to (4) with (9) and (10), or with the impulse ratio (26), solved for the impulse.

In the frame of the contact surface the relative velocity at the impact centre changes by K P, K being the inverse mass
of both vehicles there. e_n and e_t say what it changes to; or e_n and the ratio P_t/P_n do.
"""

from __future__ import annotations

from templates.description import Equation, Section
from templates.two_vehicles.equations import CENTRES, MASSES
from templates.units import MPH
from templates.vehicles import for_both

__all__ = ["model_sections"]

_BEFORE = (
    Equation("V{j}_i", "V{j}i", "{who} impact speed", "[ft|m]/s", f"V{{j}}_before/({MPH})", "input"),
    Equation("omega{j}_i", "ω{j}i", "{who} yaw rate before", "rad/s", "RADIANS(omega{j}_deg)", "input"),
)

_CONTACT = (
    Equation(
        "c_{j}",
        "c{j}",
        "{who} CG, tangential coordinate",
        "[ft|m]",
        "a_{j}*COS(RADIANS(gamma_t))+b_{j}*SIN(RADIANS(gamma_t))",
        "notation",
    ),
    Equation(
        "d_{j}",
        "d{j}",
        "{who} CG, normal coordinate",
        "[ft|m]",
        "b_{j}*COS(RADIANS(gamma_t))-a_{j}*SIN(RADIANS(gamma_t))",
        "notation",
    ),
    Equation(
        "V_close_n",
        "Vclose,n",
        "Closing speed at the impact centre, normal",
        "[ft|m]/s",
        "V1_i*SIN(RADIANS(alpha_1-gamma_t))-V2_i*SIN(RADIANS(alpha_2-gamma_t))-c_1*omega1_i+c_2*omega2_i",
        "eq (7), below the line",
        "Normal n = (−sin γ, cos γ), tangent t = (cos γ, sin γ).",
    ),
    Equation(
        "V_close_t",
        "Vclose,t",
        "Closing speed at the impact centre, tangential",
        "[ft|m]/s",
        "V1_i*COS(RADIANS(alpha_1-gamma_t))-V2_i*COS(RADIANS(alpha_2-gamma_t))+d_1*omega1_i-d_2*omega2_i",
        "eq (8), below the line",
        "With +d ω: eq (8) as printed has a tangent of the other handedness.",
    ),
    Equation(
        "K_nn",
        "Knn",
        "Inverse mass, normal",
        "[ft/(lb·s²)|1/kg]",
        "1/m_1+1/m_2+c_1^2/I_1+c_2^2/I_2",
        "eqs (3) to (6)",
        number_format="0.000000",
    ),
    Equation(
        "K_tt",
        "Ktt",
        "Inverse mass, tangential",
        "[ft/(lb·s²)|1/kg]",
        "1/m_1+1/m_2+d_1^2/I_1+d_2^2/I_2",
        "eqs (3) to (6)",
        number_format="0.000000",
    ),
    Equation(
        "K_nt",
        "Knt",
        "Inverse mass, coupling",
        "[ft/(lb·s²)|1/kg]",
        "-(c_1*d_1/I_1+c_2*d_2/I_2)",
        "eqs (3) to (6)",
        "An impulse off the CG turns the vehicle: a normal one also changes the tangential speed.",
        number_format="0.000000",
    ),
)

_IMPULSE = (
    Equation(
        "e_t_used",
        "e_t used",
        "Tangential restitution used",
        "",
        "IF(closure=1,e_t,0)",
        "closure",
        "Closure 2 compares with e_t = 0: the contact points stop sliding.",
    ),
    Equation(
        "P_n_full",
        "Pn0",
        "Normal impulse for e_n and e_t used",
        "[lb·s|N·s]",
        "((1+e_t_used)*V_close_t*K_nt-(1+e_n)*V_close_n*K_tt)/(K_nn*K_tt-K_nt^2)",
        "eqs (1) to (4), (9), (10)",
        number_format="#,##0.00",
    ),
    Equation(
        "P_t_full",
        "Pt0",
        "Tangential impulse for e_n and e_t used",
        "[lb·s|N·s]",
        "((1+e_n)*V_close_n*K_nt-(1+e_t_used)*V_close_t*K_nn)/(K_nn*K_tt-K_nt^2)",
        "eqs (1) to (4), (9), (10)",
        number_format="#,##0.00",
    ),
    Equation(
        "mu_full",
        "μ0",
        "Impulse ratio for e_n and e_t used",
        "",
        "P_t_full/P_n_full",
        "eq (26)",
        "In closure 2 the most that friction can reach: with it, sliding ends.",
    ),
    Equation(
        "mu_used",
        "μ used",
        "Impulse ratio used",
        "",
        "IF(closure=1,mu_full,SIGN(mu_full)*MIN(mu,ABS(mu_full)))",
        "eq (26)",
        "Closure 2: friction against the sliding, as far as it slides.",
    ),
    Equation(
        "P_n",
        "Pn",
        "Normal impulse on «1»",
        "[lb·s|N·s]",
        "-(1+e_n)*V_close_n/(K_nn+mu_used*K_nt)",
        "eqs (9), (26)",
        number_format="#,##0.00",
    ),
    Equation(
        "P_t", "Pt", "Tangential impulse on «1»", "[lb·s|N·s]", "mu_used*P_n", "eq (26)", number_format="#,##0.00"
    ),
    Equation(
        "P_x",
        "Px",
        "Impulse on «1», X",
        "[lb·s|N·s]",
        "P_t*COS(RADIANS(gamma_t))-P_n*SIN(RADIANS(gamma_t))",
        "axes",
        "«2» receives the opposite impulse.",
        number_format="#,##0.00",
    ),
    Equation(
        "P_y",
        "Py",
        "Impulse on «1», Y",
        "[lb·s|N·s]",
        "P_t*SIN(RADIANS(gamma_t))+P_n*COS(RADIANS(gamma_t))",
        "axes",
        number_format="#,##0.00",
    ),
)

_AFTER = (
    Equation("dV_{j}", "ΔV{j}", "{who} change in velocity", "[ft|m]/s", "SQRT(P_n^2+P_t^2)/m_{j}", "eq (19)"),
    Equation("dV{j}_x", "ΔV{j}x", "{who} change in velocity, X", "[ft|m]/s", "<|->P_x/m_{j}", "eq (5)"),
    Equation("dV{j}_y", "ΔV{j}y", "{who} change in velocity, Y", "[ft|m]/s", "<|->P_y/m_{j}", "eq (6)"),
    Equation(
        "V{j}_xf", "V{j}xf", "{who} velocity after, X", "[ft|m]/s", "V{j}_i*COS(RADIANS(alpha_{j}))+dV{j}_x", "eq (5)"
    ),
    Equation(
        "V{j}_yf", "V{j}yf", "{who} velocity after, Y", "[ft|m]/s", "V{j}_i*SIN(RADIANS(alpha_{j}))+dV{j}_y", "eq (6)"
    ),
    Equation("V{j}_f", "V{j}f", "{who} speed after", "[ft|m]/s", "SQRT(V{j}_xf^2+V{j}_yf^2)", "definition"),
    Equation(
        "beta_{j}",
        "β{j}",
        "{who} departure angle",
        "deg",
        "IF(V{j}_f>0,MOD(DEGREES(ATAN2(V{j}_xf,V{j}_yf)),360),0)",
        "definition",
        "<0 to 360. Excel's ATAN2 takes x first; printed, as in mathematics, y is first.|>",
        number_format="0.0",
    ),
    Equation(
        "d_omega_{j}",
        "Δω{j}",
        "{who} change in yaw rate",
        "rad/s",
        "<|->(d_{j}*P_t-c_{j}*P_n)/I_{j}",
        "eq (<3|4>)",
        "<|Eq (4) with its sign corrected: «2» receives the opposite impulse.>",
    ),
    Equation("omega{j}_f", "ω{j}f", "{who} yaw rate after", "rad/s", "omega{j}_i+d_omega_{j}", "eq (<3|4>)"),
    Equation(
        "s_{j}",
        "s{j}",
        "{who} travel to rest",
        "[ft|m]",
        "V{j}_f^2/(2*g*f_{j})",
        "run-out to rest",
        "<Constant deceleration f·g along a straight path. Compare it, and β, with the scene.|>",
        number_format="0.0",
    ),
    Equation(
        "V_slide",
        "Vt,f",
        "Sliding speed left at the impact centre",
        "[ft|m]/s",
        "V_close_t+K_nt*P_n+K_tt*P_t",
        "definition",
        "0 where closure 2 ends the sliding.",
    ),
)


def model_sections() -> tuple[Section, ...]:
    """The model of two vehicles: from speeds before to motion after."""
    patterns = {
        "1  Masses, speeds before, centres of gravity": MASSES + _BEFORE + CENTRES,
        "2  The contact: closing speed, inverse mass": _CONTACT,
        "3  The impulse": _IMPULSE,
        "4  Motion after": _AFTER,
    }
    return tuple(Section(title, for_both(rows)) for title, rows in patterns.items())
