package skein.search

/** Goes through many in their order. */
private[skein] object UntilWrong:

  /** What each comes to, or the first mistake; what stands behind that is not tried. */
  def each[A, B](of: Seq[A])(one: A => Either[String, B]): Either[String, Vector[B]] =
    of.foldLeft[Either[String, Vector[B]]](Right(Vector.empty)): (before, next) =>
      before.flatMap(done => one(next).map(done :+ _))
