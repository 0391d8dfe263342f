package skein.policy

/** The function that a layer of neurons applies to its sums. */
enum Activation:
  /** 0 for negative numbers. */
  case Relu

  /** −1 to 1, smoothly. */
  case Tanh

  /** Limited to −1 and 1. */
  case Clip

  /** As in names of shapes. */
  def label: String = toString.toLowerCase(java.util.Locale.ROOT)
