package skein.settings

import com.typesafe.config.{Config, ConfigException, ConfigValue}
import java.nio.file.{Files, Path}
import java.util.Locale
import scala.jdk.CollectionConverters.*
import scala.util.Try
import skein.onnx.OnnxPolicy
import skein.policy.{Fleet, Policy, PolicyFamily, Role}
import skein.scenario.Scenarios
import skein.units.Decimals.significant
import skein.units.Expect

/** A policy as a file: the family's name and one value per parameter, in HOCON. Further entries (the
  * objective, how the policy was found) are for people. Or an ONNX file: [[skein.onnx.OnnxPolicy]].
  *
  * @param parameters the parameters' values, in the order of the family's axes
  */
final case class PolicyFile(role: Role, family: PolicyFamily, parameters: Vector[Double]):
  def policy: Policy = family.policy(parameters)

  /** The scenario with this policy for all agents of its role. */
  def flownIn(fleet: Fleet): Fleet =
    Fleet(fleet.agents.map(agent => if agent.role == role then agent.copy(policy = policy) else agent))

  def name: String =
    if family.name.startsWith(OnnxPolicy.Prefix) then family.name.take(OnnxPolicy.Prefix.length + 8)
    else family.name

  /** The text for tables and recordings: `paper-pursuer turnRateRadPerS=1.25`; [[PolicyFile.parse]] reads it
    * back.
    */
  def text: String =
    (family.name +: family.space.axes.zip(parameters).map((axis, value) => s"${axis.name}=$value")).mkString(
      " "
    )

  /** [[text]] with values rounded for people. */
  def label: String =
    val shown = family.space.axes.zip(parameters).take(PolicyFile.MostShown).map: (axis, value) =>
      s"${axis.name}=${value.significant(4)}"
    val more = family.space.dimension - shown.size
    (name +: shown).mkString(" ") + (if more > 0 then s" and $more more" else "")

  /** The text of a file, with remarks for people.
    *
    * @param remarks HOCON appended below
    */
  def hocon(remarks: String): String =
    val values = family.space.axes.zip(parameters).map((axis, value) => s"  ${axis.name} = $value")
    s"""# A policy. ./skein fly --policy FILE flies it.
       |family = "${family.name}"
       |role = ${PolicyFile.name(role)}
       |parameters {
       |${values.mkString("\n")}
       |}
       |""".stripMargin + remarks

object PolicyFile:
  private val MostShown = 4

  def name(role: Role): String = role.toString.toLowerCase(Locale.ROOT)

  def role(text: String): Either[String, Role] =
    Seq(Role.Pursuer, Role.Evader).find(name(_) == text).toRight(s"expected pursuer or evader, got '$text'")

  def ofDefaults(role: Role, family: PolicyFamily): PolicyFile =
    PolicyFile(role, family, family.space.defaults)

  /** The paper's policy of a role of the duel. */
  def paperOf(role: Role): PolicyFile = ofDefaults(role, PolicyFamily.paperOf(role))

  /** The role of a family, if it has a single one, or the requested role.
    *
    * @return Left says what was expected
    */
  def roleOf(family: PolicyFamily, asked: Option[String]): Either[String, Role] = asked match
    case Some(text) =>
      role(text).filterOrElse(
        family.roles,
        s"family ${family.name} is for ${family.roles.map(name).mkString(" and ")}, got '$text'"
      )
    case None =>
      family.roles.toSeq match
        case Seq(one) => Right(one)
        case several  =>
          Left(
            s"family ${family.name} is for " +
              s"${several.map(name).mkString(" and ")}: expected one of them, got none"
          )

  /** A policy for a role: from a file, or from a family with its defaults.
    *
    * @return Left says what was expected and what was given
    */
  def chosen(role: Role, text: String)(using Scenarios): Either[String, PolicyFile] =
    named(text, Some(role)).filterOrElse(
      _.role == role,
      s"expected a policy for the ${name(role)}, got one for the other role: $text"
    )

  /** A policy from a file, or from a family with its defaults.
    *
    * @param asked role if neither file nor family states one; without it, such a family is refused and such a
    *   file is a pursuer's policy
    * @return Left says what was expected and what was given
    */
  def named(text: String, asked: Option[Role])(using Scenarios): Either[String, PolicyFile] =
    summon[Scenarios].family(text) match
      case Right(family) => roleOf(family, asked.map(name)).map(ofDefaults(_, family))
      case Left(mistake) =>
        if text.exists("/.:\\".contains(_)) || Files.exists(Path.of(text)) then read(text, asked)
        else Left(s"$mistake; or a policy file")

  /** Reads a file; `evader:FILE` states the role of an ONNX file that does not note it.
    *
    * @param asked its role in that case; by default pursuer
    * @return Left says what was expected, what was found, and where
    */
  def read(path: String, asked: Option[Role] = None)(using Scenarios): Either[String, PolicyFile] =
    if path.endsWith(OnnxPolicy.Suffix) then
      path match
        case s"pursuer:$file" => ofOnnx(file, Some(Role.Pursuer), asked)
        case s"evader:$file"  => ofOnnx(file, Some(Role.Evader), asked)
        case file             => ofOnnx(file, None, asked)
    else
      HoconFile
        .read(path)
        .flatMap: file =>
          try of(file.resolve(), path)
          catch case mistake: ConfigException => Left(s"$path: ${mistake.getMessage.stripPrefix(s"$path: ")}")
        .left
        .map(ConfigMistakes.oneLine)

  private def ofOnnx(path: String, told: Option[Role], asked: Option[Role]): Either[String, PolicyFile] =
    for
      found <- OnnxPolicy.read(path)
      noted <- Expect.optional(found.role)(role(_)).left.map(mistake => s"$path: its role: $mistake")
      chosen = told.orElse(noted).orElse(asked).getOrElse(Role.Pursuer)
    yield PolicyFile(chosen, found.family, found.parameters(chosen))

  private def of(file: Config, path: String)(using Scenarios): Either[String, PolicyFile] =
    def at(value: ConfigValue)                    = s"$path, line ${value.origin.lineNumber}"
    def text(key: String): Either[String, String] =
      if !file.hasPath(key) then Left(s"$path: expected '$key', which is missing")
      else Right(file.getString(key))
    def optional(key: String) = Option.when(file.hasPath(key))(file.getString(key))

    for
      name   <- text("family")
      family <-
        summon[Scenarios].family(name).left.map(mistake => s"${at(file.getValue("family"))}: $mistake")
      role <- roleOf(family, optional("role")).left.map(mistake => s"$path: role: $mistake")
      _    <- Expect.that(file.hasPath("parameters"))(s"$path: expected 'parameters', which is missing")
      given_ = file.getObject("parameters").asScala.toMap
      names  = family.space.axes.map(_.name)
      _ <- given_.find((key, _) => !names.contains(key)) match
        case Some((key, value)) =>
          Left(s"${at(value)}: family ${family.name} has the parameters ${names.mkString(", ")}, got '$key'")
        case None => Right(())
      parameters <- Expect.each(names): name =>
        for
          value <- given_
            .get(name)
            .toRight(s"$path: parameters: expected ${names.mkString(", ")}; '$name' is missing")
          number <- value.unwrapped match
            case number: Number if number.doubleValue.isFinite => Right(number.doubleValue)
            case other => Left(s"${at(value)}: $name: expected a finite number, got '$other'")
        yield number
      chosen = PolicyFile(role, family, parameters)
      _ <- Try(chosen.policy).toEither.left.map(mistake => s"$path: ${told(family, mistake)}")
    yield chosen

  /** The message of an exception: a rejection by a family's code is the file's mistake; any other exception
    * is the family's own.
    */
  private def told(family: PolicyFamily, mistake: Throwable): String = mistake.getCause match
    case refusal: IllegalArgumentException => s"family ${family.name}: ${Expect.refused(refusal)}"
    case _                                 => mistake.getMessage

  def parse(role: Role, text: String)(using Scenarios): Either[String, PolicyFile] =
    val words = text.split(' ').toVector
    for
      family <-
        if words.head.startsWith(OnnxPolicy.Prefix) then OnnxPolicy.recorded(words.head)
        else summon[Scenarios].family(words.head)
      values = words.tail.flatMap: word =>
        word.split('=') match
          case Array(name, value) => value.toDoubleOption.filter(_.isFinite).map(name -> _)
          case _                  => None
      _ <- Expect.that(values.map(_._1) == family.space.axes.map(_.name)):
        "expected " +
          s"${family.space.axes.map(axis => s"${axis.name}=NUMBER").mkString(" ")} " +
          s"after ${family.name}, got '$text'"
    yield PolicyFile(role, family, values.map(_._2))
