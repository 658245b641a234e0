"""Rare acceptance: where the filters keep one trial in 10⁴ to 10⁷ or fewer, learn where these are and draw there.

`strata` divides the trials, `splitting` finds the accepted region in each, `learning` describes it by a mixture
of normal distributions, `resampling` draws from that and keeps independent trials of equal weight: the same sample as
plain rejection, from fewer trials. These know of a distance in standard normals only;
`limit_state_function` makes that of a model, `layered` turns thin bent layers in it into tails, `rare_switch` says when
to search, and `search` joins all. Papers are named where their methods are: subset simulation in `splitting` (Au & Beck
2001), importance sampling by mixtures in `learning` and `proposal`, rejection in `resampling`.
docs/rare-acceptance.md says why so, and how it was tested.
"""
