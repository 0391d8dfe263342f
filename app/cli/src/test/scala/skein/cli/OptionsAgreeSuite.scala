package skein.cli

/** Compares the options of all commands: a word has one meaning in all of them. */
class OptionsAgreeSuite extends munit.FunSuite:
  private val options: Seq[(Command[?], CommandOption)] =
    for command <- Main.commands; option <- command.options yield (command, option)

  private def having(flag: String): Seq[(Command[?], CommandOption)] = options.filter(_._2.flag == flag)

  test("an option takes a value either in every command or in none, and has a description"):
    for (flag, same) <- options.groupBy(_._2.flag) do
      assertEquals(same.map(_._2.takesValue).distinct.size, 1, flag)
      for (command, option) <- same do
        assert(option.summary.length > 5, s"${command.name} $flag")
        assert(command.help.contains(flag), s"${command.name} $flag")

  test("--out names a folder in every command, and no other option serves that purpose"):
    assert(having("--out").sizeIs > 6)
    for (command, option) <- having("--out") do
      assert(option.summary.startsWith("folder "), s"${command.name}: ${option.summary}")
    assertEquals(options.map(_._2.flag).filter(Set("--output", "--folder", "--dir", "-o")), Seq.empty)

  test("--plant is the simulated model, --predictor the predicting one, and --model does not exist"):
    assertEquals(having("--model"), Seq.empty)
    for (command, option) <- having("--plant") do
      assert(option.summary.startsWith("model that flies"), command.name)
    for (command, option) <- having("--predictor") do
      assert(option.summary.startsWith("model that predicts"), command.name)

  test("the options for scenario, settings, seed and loops have equal descriptions in all commands"):
    for flag <- Seq("--set", "--seed") do
      val words = having(flag).map(_._2.summary.takeWhile(letter => letter != '(' && letter != ',').trim)
      assertEquals(words.distinct.size, 1, words.toString)
    for (command, option) <- having("--loop") do
      assertEquals(option.values, OptionValues.known("loop"), command.name)

  test("every command with tables prints them as JSON, too"):
    val plain =
      Set(
        "serve",
        "link",
        "link-fit",
        "export",
        "import",
        "replay",
        "digest",
        "new",
        "completion",
        "worker",
        "cluster",
        "decide"
      )
    for command <- Main.commands if !plain(command.name) do
      val json = command.options.find(_.flag == "--json")
      assert(json.exists(_.summary.contains("JSON on standard output")), command.name)
