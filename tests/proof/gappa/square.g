# The square of a norm, S (1 + t): each square and each sum of what is not negative is off by u = 2^-53
# at most, so 1 + t is a mean of products of three such factors and lies between the least and the
# largest of them.
{ e1 in [-1b-53,1b-53] /\ e2 in [-1b-53,1b-53] /\ e3 in [-1b-53,1b-53]
  -> (1 + e1) * (1 + e2) * (1 + e3) - 1 in [-0x1.80000001p-52,0x1.80000001p-52] }
