"""Rare acceptance: where the filters keep one trial in 10⁴ to 10⁷ or fewer, learn where these are and draw there.

`ways` divides the trials into ways, `splitting` finds the accepted region in each, `learning` describes it by a mixture
of normal distributions, `equalising` draws from that and keeps independent trials of equal weight: the same sample as
plain rejection, from fewer trials. These know of a distance in standard normals only; `landscape` makes that of a
model, `layered` turns thin bent layers in it into tails, `rare_switch` says when, `searching` joins all.
docs/rare-acceptance.md says why so, and how it was tested.
"""
