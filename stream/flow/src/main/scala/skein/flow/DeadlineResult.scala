package skein.flow

/** The fallback when a policy has not decided in time. */
enum OnOverrun[M, -O, +D]:
  /** Send no command: the vehicle continues its last command. */
  case Hold[M]() extends OnOverrun[M, Any, Nothing]

  /** Repeat the last decision; before the first decision, as [[Hold]]. */
  case Repeat[M]() extends OnOverrun[M, Any, Nothing]

  /** Use another policy, which answers immediately and shares the memory. */
  case Ask[M, O, D](policy: (M, O) => (M, D)) extends OnOverrun[M, O, D]

/** A decision and its origin: the policy, if it decided in time, or else the fallback. */
enum DeadlineResult[+D]:
  case Decided(decision: D)

  /** The policy did not decide in time, for this reason; `instead` is the fallback's decision, if there is
    * one.
    */
  case Missed(reason: Overrun, instead: Option[D])

/** The reasons why a policy made no decision. */
enum Overrun:
  case Late

  /** The policy was not called, because it still works on an earlier observation. */
  case Busy

  case Failed(cause: Throwable)
