# |v| <= limit after limit_magnitude. With the room R, and N, L the true length and the limit:
#     n = N (1 + a)    f = R L (1 + d) (1 + e) / n    w = v f (1 + c)    |w| as computed = |w| (1 + b)
# so the last line is |w| as computed over L. ROOM is kRoundingRoom of firmware/gate/limiter.h.
{ a in [-0x1.400001p-52,0x1.400001p-52] /\ b in [-0x1.400001p-52,0x1.400001p-52] /\
  c in [-1b-53,1b-53] /\ d in [-1b-53,1b-53] /\ e in [-1b-53,1b-53]
  -> ROOM * (1 + d) * (1 + e) * (1 + c) * (1 + b) / (1 + a) in [0,1] }
