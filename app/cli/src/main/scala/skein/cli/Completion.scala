package skein.cli

/** Writes shell completion scripts from the commands' own definitions. */
private[cli] object Completion:
  val Shells: Seq[String] = Seq("bash", "zsh")

  /** A script for bash that completes the program's commands, each one's options, known values, and otherwise
    * file names.
    */
  def bash(program: String, commands: Seq[Command[?]]): String =
    val values =
      for
        command <- commands
        option  <- command.options if option.takesValue
      yield
        val does =
          if option.values.isEmpty then """COMPREPLY=($(compgen -f -- "$word")); return"""
          else s"words='${option.values.mkString(" ")}'"
        s"    '${command.name} ${option.flag}') $does ;;"
    val flags = commands.map(command =>
      s"      ${command.name}) words='${command.options.map(_.flag).mkString(" ")} --help' ;;"
    )
    s"""# bash completion of $program: source <(./$program completion bash)
       |_$program() {
       |  local word=$${COMP_WORDS[COMP_CWORD]} words=''
       |  if [ "$$COMP_CWORD" -eq 1 ]; then
       |    COMPREPLY=($$(compgen -W '${commands.map(_.name).mkString(" ")} --help --version' -- "$$word"))
       |    return
       |  fi
       |  case "$${COMP_WORDS[1]} $${COMP_WORDS[COMP_CWORD - 1]}" in
       |${values.mkString("\n")}
       |    *)
       |      if [[ $$word != -* ]]; then COMPREPLY=($$(compgen -f -- "$$word")); return; fi
       |      case $${COMP_WORDS[1]} in
       |${flags.map("  " + _).mkString("\n")}
       |      esac ;;
       |  esac
       |  COMPREPLY=($$(compgen -W "$$words" -- "$$word"))
       |}
       |complete -o filenames -F _$program $program""".stripMargin

  /** A script for zsh, which completes like the script for bash and shows a description of each option. */
  def zsh(program: String, commands: Seq[Command[?]]): String =
    def quoted(text: String)    = text.replace("'", "'\\''")
    def bracketed(text: String) = quoted(text.replace("[", "\\[").replace("]", "\\]"))
    val described               =
      commands.map(command => s"    '${command.name}:${quoted(command.summary.replace(":", "\\:"))}'")
    val arguments = commands.map: command =>
      val options = command.options.map: option =>
        val value =
          if !option.takesValue then ""
          else if option.values.isEmpty then ":value:_files"
          else s":value:(${option.values.mkString(" ")})"
        s"'*${option.flag}[${bracketed(option.summary)}]$value'"
      s"    ${command.name}) _arguments " +
        s"${(options :+ "'--help[lists the options]'" :+ "'*:file:_files'").mkString(" ")} ;;"
    s"""#compdef $program
       |# zsh completion of $program: source <(./$program completion zsh)
       |_$program() {
       |  local -a commands
       |  commands=(
       |${described.mkString("\n")}
       |  )
       |  if (( CURRENT == 2 )); then _describe command commands; return; fi
       |  shift words
       |  (( CURRENT-- ))
       |  case $$words[1] in
       |${arguments.mkString("\n")}
       |  esac
       |}
       |compdef _$program $program""".stripMargin
