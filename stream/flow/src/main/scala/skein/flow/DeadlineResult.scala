package skein.flow

/** What to do when a policy has not decided in time. */
enum OnOverrun[M, -O, +D]:
  /** Command nothing: the vehicle goes on under its last command. */
  case Hold[M]() extends OnOverrun[M, Any, Nothing]

  /** Decide as the last time; before the first decision, as [[Hold]]. */
  case Repeat[M]() extends OnOverrun[M, Any, Nothing]

  /** Ask another policy, which answers at once and shares the memory. */
  case Ask[M, O, D](policy: (M, O) => (M, D)) extends OnOverrun[M, O, D]

/** How a decision came about. */
enum DeadlineResult[+D]:
  /** The policy decided in time. */
  case Decided(decision: D)

  /** The policy did not, for this reason; so this is decided instead, or nothing. */
  case Missed(reason: Overrun, instead: Option[D])

/** Why a policy gave no decision. */
enum Overrun:
  /** It did not answer within the deadline. */
  case Late

  /** It was not asked, for it still works on an earlier observation. */
  case Busy

  /** It failed. */
  case Failed(cause: Throwable)
