package skein.environment

/** An environment's behaviour at the end of an episode, in Gymnasium's terms. */
enum Autoreset:
  /** The next step ignores its action and returns the next episode's first observation. */
  case NextStep

  /** The step that ends an episode returns the next one's first observation; the last observation is stored
    * separately.
    */
  case SameStep

  /** Nothing happens until the environment is reset explicitly. */
  case Disabled
