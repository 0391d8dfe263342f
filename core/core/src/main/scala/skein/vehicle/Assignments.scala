package skein.vehicle

import skein.units.Expect

/** Reads texts such as `mass=1.3,wind=8/0/0`. Left says what was expected. */
private[vehicle] object Assignments:

  /** Takes the words of a text, each with another name, into a value.
    *
    * @param one takes one word
    */
  def read[A](text: String, empty: A)(one: (A, String) => Either[String, A]): Either[String, A] =
    type Read = (value: A, names: Set[String])
    val none: Either[String, Read] = Right((value = empty, names = Set()))
    text
      .split(",", -1)
      .foldLeft(none): (before, word) =>
        for
          read <- before
          name = word.takeWhile(_ != '=')
          _    <- Expect.that(!read.names(name))(s"$name stands twice")
          next <- one(read.value, word)
        yield (value = next, names = read.names + name)
      .map(_.value)

  def number(word: String, text: String, least: Double, most: Double): Either[String, Double] =
    text.toDoubleOption
      .filter(x => x >= least && x <= most)
      .toRight(s"expected a number from $least to $most, got '$word'")

  def numbers(
      word: String,
      text: String,
      count: Int,
      least: Double,
      most: Double
  ): Either[String, Vector[Double]] =
    val parts = text.split("/", -1)
    for
      _    <- Expect.that(parts.length == count)(s"expected $count numbers between /, got '$word'")
      read <- Expect.each(parts)(number(word, _, least, most))
    yield read
