/* Stands in for python.exe under Wine, where there is none: joins whoever started it to a worker outside.
 *
 * It tells its command line to the local port RELAY_PORT and waits for a byte. Then it passes its stdin on there, and
 * what comes back to its stdout; what comes from the port RELAY_ERRORS goes to its stderr. It leaves with exit code 3
 * when the worker has left. */

#include <winsock2.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <windows.h>

static SOCKET dial(const char *port)
{
    struct sockaddr_in there = {.sin_family = AF_INET};
    there.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    there.sin_port = htons((unsigned short)atoi(getenv(port)));
    SOCKET line = socket(AF_INET, SOCK_STREAM, 0);
    if (connect(line, (struct sockaddr *)&there, sizeof there))
        exit(4);
    setsockopt(line, IPPROTO_TCP, TCP_NODELAY, (const char *)&(BOOL){TRUE}, sizeof(BOOL));
    return line;
}

static void pour(SOCKET from, DWORD to)
{
    static _Thread_local char data[1 << 16];
    for (int count; (count = recv(from, data, sizeof data, 0)) > 0;)
        for (DWORD done = 0, part; done < (DWORD)count; done += part)
            if (!WriteFile(GetStdHandle(to), data + done, (DWORD)count - done, &part, NULL))
                return;
}

static DWORD WINAPI drain(void *line)
{
    static char data[1 << 16];
    DWORD count;
    while (ReadFile(GetStdHandle(STD_INPUT_HANDLE), data, sizeof data, &count, NULL) && count > 0)
        for (int done = 0, part; done < (int)count; done += part)
            if ((part = send(*(SOCKET *)line, data + done, (int)count - done, 0)) <= 0)
                return 1;
    shutdown(*(SOCKET *)line, SD_SEND);
    return 0;
}

static DWORD WINAPI complain(void *line)
{
    pour(*(SOCKET *)line, STD_ERROR_HANDLE);
    return 0;
}

int main(void)
{
    WSADATA data;
    char command[8192];
    WSAStartup(MAKEWORD(2, 2), &data);
    SOCKET messages = dial("RELAY_PORT");
    int size = WideCharToMultiByte(CP_UTF8, 0, GetCommandLineW(), -1, command, sizeof command, NULL, NULL);
    send(messages, command, size, 0); /* with its NUL */
    recv(messages, command, 1, 0);
    SOCKET complaints = dial("RELAY_ERRORS");
    CreateThread(NULL, 0, drain, &messages, 0, NULL);
    HANDLE last = CreateThread(NULL, 0, complain, &complaints, 0, NULL);
    pour(messages, STD_OUTPUT_HANDLE);
    WaitForSingleObject(last, 2000);
    return 3;
}
