package skein.environment

/** What follows the end of an episode, as Gymnasium names it. */
enum Autoreset:
  /** The next step ignores its action and shows the next episode's first observation. */
  case NextStep

  /** The step that ends an episode shows the next one's first observation; its last is told apart. */
  case SameStep

  /** Nothing, until a reset. */
  case Disabled
