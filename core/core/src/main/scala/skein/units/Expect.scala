package skein.units

/** Checks users' input, and creates the messages about mistakes. */
private[skein] object Expect:

  /** Right if the input is right; Left contains the mistake: what was expected, and what was received. */
  def that[E](isRight: Boolean)(mistake: => E): Either[E, Unit] = Either.cond(isRight, (), mistake)

  /** Converts each element in order; stops at the first mistake. */
  def each[A, E, B](of: IterableOnce[A])(one: A => Either[E, B]): Either[E, Vector[B]] =
    of.iterator.foldLeft[Either[E, Vector[B]]](Right(Vector.empty)): (before, next) =>
      before.flatMap(done => one(next).map(done :+ _))

  /** Checks that a number is neither below the least nor above the most. */
  def within(name: String, value: Long, least: Long, most: Long): Either[String, Unit] =
    that(value >= least && value <= most)(s"$name: expected $least to $most, got $value")

  /** Converts an optional value; fails only if there is one, and it is wrong. */
  def optional[A, E, B](of: Option[A])(one: A => Either[E, B]): Either[E, Option[B]] =
    of.fold(Right(None))(one(_).map(Some(_)))

  /** Converts each element, or returns every mistake, one per line. */
  def all[A, B](of: Seq[A])(one: A => Either[String, B]): Either[String, Seq[B]] =
    val (wrong, right) = of.map(one).partitionMap(identity)
    Either.cond(wrong.isEmpty, right, wrong.mkString("\n"))

  /** The choice with this label; Left lists all labels and the given text. */
  def oneOf[A](choices: Array[A], text: String)(label: A => String): Either[String, A] =
    choices.find(label(_) == text).toRight(s"expected ${choices.map(label).mkString(" or ")}, got '$text'")

  def refused(by: IllegalArgumentException): String =
    Option(by.getMessage).fold(by.toString)(_.stripPrefix("requirement failed: "))
