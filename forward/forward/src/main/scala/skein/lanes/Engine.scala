package skein.lanes

/** What flies worlds forward, and why nothing faster does. Chosen once, and shown as it is.
  *
  * @param kind of the slowest, where links differ
  * @param text a line for the user
  * @param sideBySide how many candidates that share episodes take no longer than one
  */
final case class Engine(kind: Engine.Kind, text: String, sideBySide: Int = 1):

  /** Whether whole worlds fly by vectors. */
  def fliesByLanes: Boolean = kind == Engine.Kind.Lanes || kind == Engine.Kind.Gpu

  /** Whether vehicles do, at least. */
  def isFast: Boolean = fliesByLanes || kind == Engine.Kind.Quadrotors

  override def toString: String = text

object Engine:
  enum Kind:
    /** Flights in virtual time, some a second. */
    case Flights

    /** World by world. */
    case Scalar

    /** The loops as by `Scalar`, with bodies of MuJoCo side by side, or quadrotors by vectors. */
    case Bodies, Quadrotors

    /** Worlds by vectors, on processors or on a GPU. */
    case Lanes, Gpu

  def scalar(why: String): Engine = Engine(Kind.Scalar, s"scalar: $why")

  /** Chooses among what flies worlds over links.
    *
    * @param lanes what flies by lanes over links that they know, or why nothing does
    * @param refusals by link, why no lanes fly over it
    * @param stepped what steps vehicles side by side, if anything does
    * @param gpu what flies in place of lanes, or why it does not; none where nobody asked for it
    * @param sideBySide see [[Engine]], by lanes
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
