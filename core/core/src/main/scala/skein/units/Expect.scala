package skein.units

/** What users state, held to what is expected of it. */
private[skein] object Expect:

  /** Nothing, or the mistake: what was expected, and what came. */
  def that[E](isRight: Boolean)(mistake: => E): Either[E, Unit] = Either.cond(isRight, (), mistake)

  /** What each comes to, in their order, or the first mistake; what stands behind that is not tried. */
  def each[A, E, B](of: IterableOnce[A])(one: A => Either[E, B]): Either[E, Vector[B]] =
    of.iterator.foldLeft[Either[E, Vector[B]]](Right(Vector.empty)): (before, next) =>
      before.flatMap(done => one(next).map(done :+ _))

  /** What each comes to, or every mistake, a line each. */
  def all[A, B](of: Seq[A])(one: A => Either[String, B]): Either[String, Seq[B]] =
    val (wrong, right) = of.map(one).partitionMap(identity)
    Either.cond(wrong.isEmpty, right, wrong.mkString("\n"))

  /** What a `require` refused, for a person. */
  def refused(by: IllegalArgumentException): String =
    Option(by.getMessage).fold(by.toString)(_.stripPrefix("requirement failed: "))
