package skein.policy

/** The function that a layer of neurons applies to its weighted sums. */
enum Activation:
  case Relu

  case Tanh

  case Clip

  /** Exponential below 0, down to −1; the identity above 0. */
  case Elu

  /** Whether the function's values lie between −1 and 1. */
  def squashes: Boolean = this == Tanh || this == Clip

  def label: String = toString.toLowerCase(java.util.Locale.ROOT)
