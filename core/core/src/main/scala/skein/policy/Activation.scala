package skein.policy

/** The function that a layer of neurons applies to its sums. */
enum Activation:
  /** 0 for negative numbers. */
  case Relu

  /** −1 to 1, smoothly. */
  case Tanh

  /** Limited to −1 and 1. */
  case Clip

  /** −1 upwards, exponentially, for negative numbers; those above 0 as they are. */
  case Elu

  /** Whether what comes of it is from −1 to 1. */
  def squashes: Boolean = this == Tanh || this == Clip

  /** As in names of shapes. */
  def label: String = toString.toLowerCase(java.util.Locale.ROOT)
