package skein.lanes

/** The engine that simulates worlds, with the reason why no faster one does. Chosen once, and shown to the
  * user.
  *
  * @param kind of the slowest, where links differ
  * @param text a line for the user
  * @param sideBySide number of candidates with shared episodes that take no longer than one
  */
final case class Engine(kind: Engine.Kind, text: String, sideBySide: Int = 1):

  def fliesByLanes: Boolean = kind == Engine.Kind.Lanes || kind == Engine.Kind.Gpu

  def isFast: Boolean = fliesByLanes || kind == Engine.Kind.Quadrotors

  override def toString: String = text

object Engine:
  enum Kind:
    /** Flights in virtual time, a few per second. */
    case Flights

    /** The scalar reference, one world at a time. */
    case Scalar

    /** The loops as in `Scalar`, with MuJoCo's bodies side by side, or quadrotors by SIMD. */
    case Bodies, Quadrotors

    /** Whole worlds by SIMD, on processors or on a GPU. */
    case Lanes, Gpu

  def scalar(why: String): Engine = Engine(Kind.Scalar, s"scalar: $why")

  /** Chooses an engine for worlds over links.
    *
    * @param lanes the SIMD engine over links that it supports, or why there is none
    * @param refusals by link, why SIMD does not support it
    * @param stepped the engine that steps vehicles side by side, if any
    * @param gpu the engine that replaces SIMD, or why it does not; None where it was not requested
    * @param sideBySide see [[Engine]], for SIMD
    */
  private[lanes] def of(
      lanes: Either[String, String],
      refusals: Seq[Option[String]],
      stepped: Option[Engine],
      gpu: Option[Either[String, Engine]],
      sideBySide: => Int
  ): Engine =
    val refused = refusals.flatten
    (lanes, gpu) match
      case (Left(why), _)                                         => stepped.getOrElse(scalar(why))
      case (_, Some(Right(faster)))                               => faster
      case _ if refused.nonEmpty && refused.size == refusals.size => stepped.getOrElse(scalar(refused.head))
      case (Right(what), _)                                       =>
        val why = gpu.flatMap(_.left.toOption).fold("")(why => s" ($why)")
        if refused.isEmpty then Engine(Kind.Lanes, s"SIMD, $what$why", sideBySide)
        else
          val over = s"over ${refusals.size - refused.size} of ${refusals.size} links"
          Engine(Kind.Scalar, s"SIMD, $what, $over; scalar over the others: ${refused.head}$why")
