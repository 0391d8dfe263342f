package skein.flow

/** What to do when a policy has not decided in time. */
enum OnOverrun[M, -O, +D]:
  /** Send no command: the vehicle continues its last command. */
  case Hold[M]() extends OnOverrun[M, Any, Nothing]

  /** Repeat the last decision; before the first decision, as [[Hold]]. */
  case Repeat[M]() extends OnOverrun[M, Any, Nothing]

  /** Use another policy, which answers immediately and shares the memory. */
  case Ask[M, O, D](policy: (M, O) => (M, D)) extends OnOverrun[M, O, D]

/** A decision with its origin: the policy in time, or the fallback. */
enum DeadlineResult[+D]:
  case Decided(decision: D)

  /** The policy did not, for this reason; the fallback decided instead, or nothing. */
  case Missed(reason: Overrun, instead: Option[D])

/** Why a policy made no decision. */
enum Overrun:
  case Late

  /** It was not called: it still works on an earlier observation. */
  case Busy

  case Failed(cause: Throwable)
