# A norm, sqrt(S (1 + t)) (1 + g), is off by 2.5 u and a little. The little, 2^-76, has room for squares
# that underflow: 2^-1074 beside a square of 1e-300 at least.
{ t in [-0x1.80000001p-52,0x1.80000001p-52] /\ g in [-1b-53,1b-53]
  -> sqrt(1 + t) * (1 + g) - 1 in [-0x1.400001p-52,0x1.400001p-52] }
