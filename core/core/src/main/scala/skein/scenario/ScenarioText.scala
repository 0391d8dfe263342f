package skein.scenario

/** Scenarios given by the text of their [[ScenarioFile]], which may replace the name of a scenario
  * everywhere.
  */
private[skein] object ScenarioText:

  /** Whether a text is a scenario file, and not the name of a scenario. */
  def isText(text: String): Boolean = text.startsWith(ScenarioFile.Head + " ")

  /** The name of a scenario for messages: the name in its file, or the given name. */
  def called(scenario: String): String =
    if isText(scenario) then read(scenario).fold(_ => ScenarioFile.Head, _.name) else scenario

  @volatile private var last = Option.empty[(String, ScenarioKind[FileScenario])]

  /** Reads a file's text. Repeated calls with one text return one object, so that the scenario is compiled
    * once.
    *
    * @return Left with one line that says what was expected, what was given, and in which line
    */
  def read(text: String): Either[String, ScenarioKind[FileScenario]] = last.filter(_._1 == text) match
    case Some((_, same)) => Right(same)
    case None            =>
      for
        file <- ScenarioReader.read(text)
        kind = FileScenario.kind(file)
        _ <- kind.read(Map.empty).left.map(mistakes => s"by its defaults: ${mistakes.mkString("; ")}")
      yield
        last = Some((text, kind))
        kind
