package skein.policy

/** What a layer of neurons makes of its sums. */
enum Activation:
  /** What is negative becomes 0. */
  case Relu

  /** −1 to 1, smoothly. */
  case Tanh

  /** What is beyond −1 and 1 becomes −1 and 1. */
  case Clip

  /** As in names of shapes. */
  def label: String = toString.toLowerCase(java.util.Locale.ROOT)
