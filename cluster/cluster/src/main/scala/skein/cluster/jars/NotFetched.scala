package skein.cluster.jars

/** Why a program did not come. */
private[cluster] enum NotFetched:
  /** What came, or was to come, is not taken. */
  case Refused(reason: String)

  /** The coordinator does not answer. */
  case CutOff
