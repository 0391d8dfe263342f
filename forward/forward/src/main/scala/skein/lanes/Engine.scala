package skein.lanes

/** The engine that simulates worlds. Its text includes the reason why no faster engine is used, and is shown
  * to the user.
  *
  * @param kind the kind of engine; if links differ, the slowest of their engines
  * @param text one line for the user
  * @param sideBySide number of candidates with shared episodes that are simulated in the time of one
  */
final case class Engine(kind: Engine.Kind, text: String, sideBySide: Int = 1):

  def fliesByLanes: Boolean = kind == Engine.Kind.Lanes || kind == Engine.Kind.Gpu

  def isFast: Boolean = fliesByLanes || kind == Engine.Kind.Quadrotors

  override def toString: String = text

object Engine:
  enum Kind:
    /** Flies each episode in virtual time, a few per second. */
    case Flights

    /** The scalar reference, which simulates one world at a time. */
    case Scalar

    /** Loops as in `Scalar`, but with the bodies of many worlds stepped together, by MuJoCo or, for
      * quadrotors, with SIMD.
      */
    case Bodies, Quadrotors

    /** Whole worlds with SIMD, on the processors or on a GPU. */
    case Lanes, Gpu

  def scalar(why: String): Engine = Engine(Kind.Scalar, s"scalar: $why")

  /** Chooses an engine for worlds over several links.
    *
    * @param lanes text of the SIMD engine, or why SIMD does not support the worlds
    * @param refusals why SIMD does not support each link; None if it does
    * @param stepped the engine that steps vehicles together, if any
    * @param gpu the engine that replaces SIMD, or why it does not; None if it was not requested
    * @param sideBySide `sideBySide` of the SIMD engine; see [[Engine]]
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
