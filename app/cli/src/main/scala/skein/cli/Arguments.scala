package skein.cli

import java.util.Locale
import mainargs.Flag
import skein.settings.{ConfigKeys, TextFile}
import skein.signal.LatencyProfile
import skein.units.Expect

/** Parses options that several commands share. */
private[cli] object Arguments:

  /** Parses settings of a scenario, `NAME=VALUE` each, by their keys, each once; Left lists every mistake. */
  def settings(texts: Seq[String]): Either[String, Seq[(String, String)]] =
    for
      told <- Expect.all(texts): text =>
        text.split("=", 2) match
          case Array(name, value) if name.nonEmpty => Right(ConfigKeys.ofField(name) -> value)
          case _ => Left(s"--set: expected NAME=VALUE, for example vehicles=8, got '$text'")
      _ <- Expect.all(told.map(_._1).distinct): key =>
        val values = told.collect { case (`key`, value) => value }
        Expect.that(values.size == 1)(s"--set: expected '$key' once, got ${values.mkString(" and ")}")
    yield told

  /** The options that differ from their defaults, including those of option groups. An option given its
    * default value cannot be distinguished from an absent one.
    */
  def told(options: Product): Set[String] =
    options.productElementNames.zip(options.productIterator).toSet.flatMap:
      case (name, Some(_))         => Set(flag(name))
      case (name, several: Seq[?]) => Option.when(several.nonEmpty)(flag(name)).toSet
      case (name, switch: Flag)    => Option.when(switch.value)(flag(name)).toSet
      case (_, None)               => Set.empty
      case (_, group: Product)     => told(group)
      case _                       => Set.empty

  private def flag(name: String) =
    "--" + "[A-Z]".r.replaceAllIn(name, letter => "-" + letter.matched.toLowerCase(Locale.ROOT))

  /** Refuses options, other than `may`, that are read from the folder of the run being continued. */
  def resumed(options: Product, may: Set[String], what: String): Either[String, Unit] =
    val others = told(options) -- may - "--resume"
    Expect.that(others.isEmpty):
      s"--resume: everything but $what is taken from the folder; expected no " +
        s"other option, got ${others.toSeq.sorted.mkString(", ")}"

  def latency(text: String): Either[String, LatencyProfile] =
    LatencyProfile.parse(text, TextFile.read).left.map(_.message)
